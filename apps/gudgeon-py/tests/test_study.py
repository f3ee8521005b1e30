"""Studies in folders: the files are equal to the byte, whoever fills them."""

import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import gudgeon

SPEC = {
    "cases": [gudgeon.example("slider-straight").set({"sweeps": []})],
    "inputs": [{"path": "rig.profile.h_in", "from": "1.2 um", "to": "4 um", "points": 40}, {"path": "rig.speed", "from": "1 m/s", "to": "10 m/s", "points": 50}],
    "results": ["load", "p_max"],
}
"""2000 points of a bench."""


def parts(study: gudgeon.Study) -> dict[str, bytes]:
    return {p.name: p.read_bytes() for p in sorted((study.folder / "parts").iterdir()) if not p.name.startswith(".")}


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory) -> gudgeon.Study:
    study = gudgeon.Study.new(tmp_path_factory.mktemp("study") / "alone", SPEC)
    study.run(threads=1)
    return study


def test_a_study_is_its_folder(undisturbed):
    status = undisturbed.status
    assert status["done"] == status["points"] == 2000 and status["failed"] == 0 and status["missing"] == []
    frame = undisturbed.to_dataframe()
    # Load of a slider: the speed is a factor of it.
    by_speed = frame["load"].to_numpy().reshape(40, 50)
    np.testing.assert_allclose(by_speed[:, -1] / by_speed[:, 0], 10.0, rtol=1e-9)
    assert frame.attrs["units"]["load"] == "N/m"
    assert undisturbed.collect().num_rows == 2000
    assert "2000 of 2000" in repr(gudgeon.Study.open(undisturbed.folder))
    assert undisturbed.analysis() is not None


def test_the_table_opens_elsewhere(undisturbed):
    polars, duckdb = pytest.importorskip("polars"), pytest.importorskip("duckdb")
    frame, path = undisturbed.to_dataframe(), undisturbed.folder / "table.parquet"
    told = polars.read_parquet(path)
    assert told.columns == list(frame) and told["load"].to_list() == frame["load"].tolist()
    # The query of docs/guide/src/studies.md.
    rows = duckdb.sql(f"""select "rig.speed", load from '{path}' where code = ''""").fetchall()
    assert rows == list(zip(frame["rig.speed"].tolist(), frame["load"].tolist()))


def test_threads_give_equal_bytes(undisturbed, tmp_path):
    study = gudgeon.Study.new(tmp_path / "s", SPEC)
    study.run(threads=2)
    assert parts(study) == parts(undisturbed)


def test_a_stop_keeps_what_is_done(undisturbed, tmp_path):
    study = gudgeon.Study.new(tmp_path / "s", SPEC)
    with pytest.raises(gudgeon.RunError) as e:
        study.run(threads=1, progress=lambda phase, fraction: fraction < 0.01)
    assert e.value.code == "stopped"
    study.run()
    assert parts(study) == parts(undisturbed)


def test_what_is_no_study(tmp_path):
    with pytest.raises(ValueError, match="no study"):
        gudgeon.Study.open(tmp_path)
    with pytest.raises(gudgeon.CaseError, match="rig.speeed"):
        gudgeon.Study.new(tmp_path / "s", {**SPEC, "inputs": [{"path": "rig.speeed", "values": ["1 m/s"]}]})
    gudgeon.Study.new(tmp_path / "t", SPEC)
    with pytest.raises(ValueError, match="another study"):
        gudgeon.Study.new(tmp_path / "t", {**SPEC, "results": ["load"]})


@pytest.fixture(scope="module")
def cluster():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster, distributed.Client(cluster) as client:
        yield cluster, client


def test_dask_gives_equal_bytes(undisturbed, cluster, tmp_path):
    _, client = cluster
    study = gudgeon.Study.new(tmp_path / "s", SPEC)
    heard = []
    study.run(client, progress=lambda phase, fraction: heard.append(fraction))
    assert parts(study) == parts(undisturbed)
    assert heard[-1] == 1.0 and len(heard) == study.status["parts"]


def test_dask_with_a_worker_killed(undisturbed, cluster, tmp_path):
    _, client = cluster
    study = gudgeon.Study.new(tmp_path / "s", SPEC)
    killed = []

    def kill(phase, fraction):
        if not killed:
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    study.run(client, progress=kill)
    assert killed and parts(study) == parts(undisturbed)


def test_dask_goes_on_where_threads_were_stopped(undisturbed, cluster, tmp_path):
    _, client = cluster
    study = gudgeon.Study.new(tmp_path / "s", SPEC)
    with pytest.raises(gudgeon.RunError):
        study.run(client, progress=lambda phase, fraction: False)
    assert study.status["missing"] or study.status["parts"] == 1
    study.run(threads=2)
    assert parts(study) == parts(undisturbed)


KILLED = """
import gudgeon, sys
study = gudgeon.Study.open(sys.argv[1])
print("begun", flush=True)
study.run(threads=1)
"""


def test_a_process_that_is_killed(undisturbed, tmp_path):
    study = gudgeon.Study.new(tmp_path / "s", SPEC)
    process = subprocess.Popen([sys.executable, "-c", KILLED, str(study.folder)], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begun\n"
    process.kill()
    process.wait()
    study.run()
    assert parts(study) == parts(undisturbed)


def test_a_reset_of_the_scheduler(undisturbed, cluster, tmp_path):
    _, client = cluster
    study = gudgeon.Study.new(tmp_path / "s", SPEC)
    reset = []

    def restart(phase, fraction):
        if not reset:
            reset.append(True)
            # Restarts all workers and has the scheduler forget all tasks.
            client.restart()

    study.run(client, progress=restart)
    assert reset and parts(study) == parts(undisturbed)


def start(*arguments: str) -> subprocess.Popen:
    return subprocess.Popen([sys.executable, "-m", "distributed.cli." + arguments[0], *arguments[1:]], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def test_a_scheduler_that_is_killed(undisturbed, tmp_path):
    distributed = pytest.importorskip("distributed")
    study = gudgeon.Study.new(tmp_path / "s", SPEC)
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        port = s.getsockname()[1]
    address = f"tcp://127.0.0.1:{port}"

    def cluster() -> list[subprocess.Popen]:
        scheduler = start("dask_scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard")
        return [scheduler, start("dask_worker", address, "--nworkers", "1", "--nthreads", "1", "--no-nanny", "--no-dashboard", "--death-timeout", "60")]

    processes = cluster()
    killed = []

    def kill(phase, fraction):
        if not killed:
            killed.append(True)
            # A worker ends with its scheduler; whoever runs the cluster starts both again.
            for process in processes:
                process.kill()
                process.wait()
            processes[:] = cluster()

    try:
        with distributed.Client(address, timeout=30) as client:
            try:
                study.run(client, progress=kill)
            except gudgeon.RunError as e:
                # Where the client gives up before the scheduler is there again: what is done is kept, and the same call goes on.
                assert e.code == "dask"
    finally:
        for process in processes:
            process.kill()
            process.wait()
    assert killed and study.status["done"] > 0
    study.run()
    assert parts(study) == parts(undisturbed)


def test_a_study_file(tmp_path):
    file = tmp_path / "map.toml"
    case = Path(__file__).parents[3] / "cases" / "pin-85-alcohol.toml"
    file.write_text(f'cases = ["{case}"]\n[[inputs]]\npath = "pin.inner"\nvalues = ["12 mm", "25 mm"]\n')
    study = gudgeon.Study.new(tmp_path / "s", file)
    study.run()
    frame = study.to_dataframe()
    assert (study.status["failed"], study.status["left_out"]) == (0, 1) and frame["code"].tolist() == ["", "impossible"]
    assert frame["pin_mass"].notna().tolist() == [True, False]
