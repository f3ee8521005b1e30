"""Studies: many runs in a folder, filled by threads or by Dask."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterable, Mapping
from functools import lru_cache
from itertools import count
from os import PathLike
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from . import _native
from .case import Case, Progress
from .errors import RunError
from .values import toml

if TYPE_CHECKING:
    import pandas
    import pyarrow
    from distributed import Client, Future

__all__ = ["Study"]


class Study:
    """Many runs in a folder. It can be broken off at any time and goes on with the same call; whoever fills it, the files are equal to the byte.

    >>> import gudgeon, tempfile
    >>> spec = {
    ...     "cases": [gudgeon.example("pin-85-alcohol")],
    ...     "inputs": [{"path": "pin.inner", "from": "12 mm", "to": "14 mm", "points": 5}],
    ...     "results": ["pin_mass"],
    ... }
    >>> study = gudgeon.Study.new(tempfile.mkdtemp() + "/pins", spec)
    >>> study.run()
    >>> study.status["done"], study.to_dataframe()["pin_mass"].round(1).tolist()
    (5, [127.2, 122.6, 117.7, 112.6, 107.4])
    """

    def __init__(self, native: _native.Study) -> None:
        self._native = native

    @classmethod
    def new(cls, folder: str | PathLike[str], spec: str | PathLike[str] | Mapping[str, Any]) -> Study:
        """Makes the folder of a study, or finds it made already.

        ``spec`` is a study file, or what one says as a dictionary: ``cases`` (of :class:`gudgeon.Case`, or file names), ``inputs``, ``design``, ``results``,
        ``curves``.

        Raises :class:`gudgeon.CaseError` for a wrong one, ``ValueError`` for a folder with another study.
        """
        if not isinstance(spec, Mapping):
            return cls(_native.Study.create(Path(folder), Path(spec)))
        with tempfile.TemporaryDirectory() as beside:
            file = Path(beside) / "study.toml"
            cases = [_written(Path(beside), k, c) if isinstance(c, Case) else str(Path(c).absolute()) for k, c in enumerate(spec.get("cases", []))]
            file.write_text("".join(f"{key} = {toml(value)}\n" for key, value in {**spec, "cases": cases}.items()), encoding="utf-8")
            return cls(_native.Study.create(Path(folder), file))

    @classmethod
    def open(cls, folder: str | PathLike[str]) -> Study:
        """Opens the folder of a study."""
        return cls(_native.Study.open(Path(folder)))

    @property
    def folder(self) -> Path:
        """The folder."""
        return Path(self._native.folder())

    @property
    def status(self) -> dict[str, Any]:
        """How far it is: ``points``, ``done``, ``failed`` and ``left_out`` (of these), ``parts``, ``missing`` (numbers of parts)."""
        return self._native.status()

    def run(self, client: Client | None = None, *, threads: int = 0, retries: int = 3, progress: Progress | None = None) -> None:
        """Runs what is missing: on ``threads`` threads (0: one a core), or on the workers of a Dask ``client``.

        With Dask a part of the study is a task, which runs on one thread of a worker; workers need this package and no common folder. A task
        whose worker is lost runs again on another one, as often as Dask's ``distributed.scheduler.allowed-failures`` says; one that fails runs again ``retries`` times. After a
        restart of the scheduler, tasks that were lost with it are handed in again.

        What is done is kept, whatever happens: the same call goes on.
        """
        if client is None:
            self._native.run(threads, progress)
            return
        for attempt in count():
            missing = self.status["missing"]
            if missing and not self._fill(client, missing, attempt, retries, progress):
                raise RunError(f"Dask finished none of the {len(missing)} missing parts; what is done is kept", "dask")
            if not missing:
                return

    def _fill(self, client: Client, missing: list[int], attempt: int, retries: int, progress: Progress | None) -> bool:
        """Hands in the missing parts and puts those that come back into the folder; whether any did."""
        from distributed import as_completed

        record, parts = self._native.record(), self.status["parts"]
        # What was lost with a scheduler goes by another name when it is handed in again: news of the old ones may still be under way.
        name = f"gudgeon-{json.loads(record)['sha256'][:16]}-{attempt}"
        futures: dict[Future, int] = {client.submit(_part, record, k, key=f"{name}-{k}", retries=retries, pure=False): k for k in missing}
        done = 0
        try:
            for future in as_completed(futures):
                # Lost with its scheduler.
                if future.status not in ("finished", "error"):
                    continue
                self._native.put(futures[future], *future.result())
                done += 1
                ready = parts - len(missing) + done
                if progress is not None and progress(f"{ready} of {parts} parts", ready / parts) is False:
                    raise RunError("stopped; what is done is kept", "stopped")
        except BaseException:
            client.cancel(list(futures))
            raise
        return done > 0

    def collect(self) -> pyarrow.Table:
        """All rows that are there, in the order of the points; also written into the folder as ``table.parquet`` and ``table.csv``."""
        import pyarrow.parquet as pq

        path, _ = self._native.collect()
        return pq.read_table(path)

    def to_dataframe(self) -> pandas.DataFrame:
        """The same as a pandas DataFrame, with the units in ``attrs["units"]``."""
        table = self.collect()
        frame = table.to_pandas()
        frame.attrs["units"] = json.loads((table.schema.metadata or {}).get(b"units", b"{}"))
        return frame

    def analysis(self) -> dict[str, Any] | None:
        """What the results depend on, as the design of the study allows to say it; none while rows are missing."""
        return self._native.collect()[1]

    def __repr__(self) -> str:
        s = self.status
        return f"<Study {self.folder.name}: {s['done']} of {s['points']} points>"


def _written(folder: Path, number: int, case: Case) -> dict[str, Any]:
    """Writes a case and the files it names below a folder; what a study file says of it."""
    name, text, overrides, files = case._native.state()
    own = folder / f"case{number}"
    own.mkdir()
    for file, content in [(name, text), *files]:
        parts = PurePosixPath(file)
        if parts.is_absolute() or ".." in parts.parts:
            raise ValueError(f"the case {case.name} names the file {file}, which is not below its folder: use a study file")
        (own / file).parent.mkdir(parents=True, exist_ok=True)
        (own / file).write_text(content, encoding="utf-8")
    return {"file": f"case{number}/{name}", "name": case.name, "set": overrides}


@lru_cache(maxsize=4)
def _read(record: str) -> _native.Study:
    return _native.Study.read(record)


def _part(record: str, part: int) -> tuple[bytes, bytes | None]:
    """One part, on a worker of Dask."""
    return _read(record).compute(part, 1)
