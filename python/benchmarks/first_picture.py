"""Prints how long a new user waits for the first picture: a new environment, the wheel in it, a run, its page and a plot.

    python first_picture.py WHEEL [--cold]

With --cold pip uses no cache: NumPy and Matplotlib are downloaded, as for someone who has never installed them.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

#: What a user types after the installation; the names of page and plot are printed.
PROGRAM = """
import matplotlib
matplotlib.use("Agg")
import pontoon as pt
run = pt.run("raft", out="raft")
axes = run.to_pandas()[["raft.heave_m"]].plot()
axes.figure.savefig("heave.png")
"""


def main() -> None:
    """Installs, runs and prints the times."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("wheel", type=Path, help="the wheel")
    options.add_argument("--cold", action="store_true", help="install without the cache of pip")
    given = options.parse_args()
    wheel = given.wheel.resolve()

    with tempfile.TemporaryDirectory() as work:
        python = Path(work) / "venv" / ("Scripts" if sys.platform == "win32" else "bin") / "python"

        def timed(what: str, command: Sequence[str]) -> float:
            begun = time.perf_counter()
            subprocess.run(command, check=True, cwd=work, stdout=subprocess.DEVNULL)
            taken = time.perf_counter() - begun
            print(f"  {taken:6.1f} s  {what}", flush=True)
            return taken

        print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB")
        pip = [str(python), "-m", "pip", "install", "--quiet", *(["--no-cache-dir"] if given.cold else [])]
        total = timed("environment", [sys.executable, "-m", "venv", "venv"])
        total += timed("pip install", [*pip, str(wheel), "pandas", "matplotlib"])
        total += timed("run of raft, its page and a plot", [str(python), "-c", PROGRAM])
        for name in ("raft/report.html", "heave.png"):
            assert (Path(work) / name).stat().st_size > 1000, name
        print(f"  {total:6.1f} s  in all")


if __name__ == "__main__":
    main()
