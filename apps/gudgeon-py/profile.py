"""Prints `[profile.test]` of the workspace as the settings of the profile `dev`.

`cargo test` has built nearly all of the wheel already. maturin cannot ask cargo for the profile `test` (`cargo rustc --profile test` means something else), and cargo takes
what it built under another profile when the settings are the same.
"""

import json
import sys

try:
    import tomllib
except ImportError:  # Python 3.10
    from pip._vendor import tomli as tomllib

with open(sys.argv[1], "rb") as f:
    told = tomllib.load(f)["profile"]["test"]


def lines(path: str, table: dict) -> None:
    for key, value in table.items():
        if isinstance(value, dict):
            lines(f"{path}.{json.dumps(key)}", value)
        else:
            print(f"{path}.{key} = {json.dumps(value)}")


lines("profile.dev", told)
