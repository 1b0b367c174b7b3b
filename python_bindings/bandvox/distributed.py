"""Frames of a sequence, and parts of one volume, on the workers of a Dask cluster.

>>> from distributed import Client
>>> import bandvox.distributed as farm
>>> client = Client("tcp://scheduler:8786")
>>> farm.convert_volume(client, "scan.obj", "scan.vdb", shards=8, resolution=4096)
>>> farm.run_frames(client, "convert", "sim.####.obj", "sim.####.vdb", "1-100", resolution=512)

All machines see the files under the same names, and have Bandvox: each task is one run of the command
`bandvox`. It writes to a hidden folder beside the output. Only the run whose result has arrived
gives its files their names, so each output is written once and is whole, whatever became of other
runs. The folder is removed at the end; runs that are left see that, and end.

This module needs the package `distributed`; nothing else of Bandvox does.
"""

from __future__ import annotations

import numbers
import os
import pathlib
import re
import shutil
import tempfile
import time
from typing import Any, Callable, Dict, Iterable, List, NamedTuple, Optional, Sequence, Tuple, Union

from ._bandvox import Error
from ._dispatch import Outcome, Slots, Task, dispatch
from .types import Path

__all__ = ["FarmError", "Failure", "Report", "convert_volume", "run_frames"]

# Called with how many tasks are done, of how many, and the name of the last.
FarmProgress = Callable[[int, int, str], object]


class Failure(NamedTuple):
    """A task that came to nothing."""

    name: str  # 'frame 7', 'shard 3/8' or 'merge'
    status: int  # the exit status of the command; -1 if it did not come to run
    message: str


class Report(NamedTuple):
    """What has become of all tasks."""

    written: List[pathlib.Path]
    skipped: List[pathlib.Path]
    failures: List[Failure]
    warnings: List[Tuple[str, str]]  # of a task by its name
    tries: int  # runs of the tasks that have come to an end
    workers: Dict[str, int]  # tasks that each worker has done
    seconds: float

    def __str__(self) -> str:
        lines = [f"{len(self.written)} written, {len(self.skipped)} skipped, "
                 f"{len(self.failures)} failed, {self.tries} tries, {self.seconds:.1f} s"]
        lines += [f"{one.name}: {one.message} (status {one.status})" for one in self.failures]
        return "\n".join(lines)


class FarmError(Error):
    """Some task has failed; `report` says which, and what became of the others."""

    def __init__(self, report: Report) -> None:
        super().__init__(str(report))
        self.report = report


def run_frames(
    client: Any,
    command: str,
    inputs: Union[Path, Sequence[Path]],
    output: Path,
    frames: Union[str, Iterable[int]],
    *,
    keep_going: bool = False,
    skip_existing: bool = False,
    threads: Optional[int] = None,
    memory: Optional[int] = None,
    retries: int = 2,
    executable: str = "bandvox",
    progress: Optional[FarmProgress] = None,
    **options: Any,
) -> Report:
    """Run `bandvox convert` or `bandvox render` on frames of a sequence, one to a task.

    client: a distributed.Client. output, and inputs that change with the frame, have a place for the
    number, #### or %04d. frames: numbers, or '7', '1-100' or '1-100x2'. options: those of the
    command, as resolution=512 or half=True. threads: of each task; None gives one task all of a
    worker's. memory: bytes that a task needs: a worker gets as many at a time as it has memory for.
    retries: how often a task is begun again when its worker is lost, its memory does not suffice or
    its disk is full; wrong options and inputs only would fail again. skip_existing: leave what is
    done as `convert --skip-existing` does. progress: called here after each task.

    Returns the report. Raises FarmError after the first failure, or with keep_going after all
    others are done only if every frame has failed. ValueError if no worker is large enough.
    """
    if command not in ("convert", "render"):
        raise ValueError(f"command is '{command}'; expected 'convert' or 'render'")
    if skip_existing and command != "convert":
        raise ValueError("skip_existing is for 'convert'")
    numbers = frame_numbers(frames)
    target = pathlib.Path(os.path.abspath(output))
    if with_frame(target.name, 0) == target.name:
        raise ValueError(f"output is '{output}'; expected a place for the number of a frame in the "
                         "file's name, as in name.####.vdb")
    if isinstance(inputs, (str, os.PathLike)):
        inputs = [inputs]
    files = [_absolute(path) for path in inputs]
    words = [executable, command, *files, *option_words(options)]
    tasks = [Task(f"frame {number}", f"bandvox-{command}-{number:04d}",
                  tuple(words + ["--frames", str(number)]), target.name,
                  str(target.parent / with_frame(target.name, number)) if skip_existing else "")
             for number in numbers]
    run = _Run(client, target, _slots(threads, memory), retries, len(tasks), progress)
    with run:
        run.do(tasks, keep_going, publish=True)
    report = run.report()
    if report.failures and (not keep_going or len(report.failures) == len(tasks)):
        raise FarmError(report)
    return report


def convert_volume(
    client: Any,
    input: Path,
    output: Path,
    *,
    shards: int,
    threads: Optional[int] = None,
    memory: Optional[int] = None,
    retries: int = 2,
    executable: str = "bandvox",
    progress: Optional[FarmProgress] = None,
    **options: Any,
) -> Report:
    """Run `bandvox convert` in parts (--shard) and join them (merge) to what one machine would make.

    shards: how many parts, each a task of its own; a few for each worker even out differences between
    them. Each worker reads the whole input; the one that joins has the whole result in memory. The
    other arguments are those of run_frames. Raises FarmError if a part, or joining, has failed: then
    there is no output, or what was there before.
    """
    if shards < 2:
        raise ValueError(f"shards is {shards}; expected 2 or more")
    target = pathlib.Path(os.path.abspath(output))
    if target.suffix.lower() != ".vdb":
        raise ValueError(f"output is '{output}'; expected a .vdb file")
    words = [executable, "convert", _absolute(input), *option_words(options)]
    tasks = [Task(f"shard {i}/{shards}", f"bandvox-shard-{i:04d}",
                  tuple(words + ["--shard", f"{i}/{shards}"]), "part.vdb")
             for i in range(1, shards + 1)]
    run = _Run(client, target, _slots(threads, memory), retries, shards + 1, progress)
    with run:
        parts = run.do(tasks, keep_going=False, publish=False)
        if len(parts) == shards:
            joining = [executable, "merge", *(parts[task.name].files[0] for task in tasks)]
            # Parts that are kept as 16 bits are joined as such.
            joining += option_words({"compression": options.get("compression")})
            run.do([Task("merge", "bandvox-merge", tuple(joining), target.name)],
                   keep_going=False, publish=True)
    report = run.report()
    if report.failures:
        raise FarmError(report)
    return report


class _Run:
    """The tasks of one call, and the folder that their runs write to."""

    def __init__(self, client: Any, target: pathlib.Path, slots: Slots, retries: int, total: int,
                 progress: Optional[FarmProgress]) -> None:
        if retries < 0:
            raise ValueError(f"retries is {retries}; expected 0 or more")
        self.client, self.target, self.slots, self.retries = client, target, slots, retries
        self.total, self.progress = total, progress
        self.start = time.monotonic()
        self.found = Report([], [], [], [], 0, {}, 0.0)
        self.tries = 0
        self.done = 0
        self.folder = pathlib.Path()

    def __enter__(self) -> None:
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix=".bandvox-farm-", dir=self.target.parent))

    def __exit__(self, *_: object) -> None:
        # A run that is still going may be making a file while its folder is removed.
        for _attempt in range(10):
            shutil.rmtree(self.folder, ignore_errors=True)
            if not self.folder.exists():
                break
            time.sleep(0.1)

    def do(self, tasks: Sequence[Task], keep_going: bool, publish: bool) -> Dict[str, Outcome]:
        """The outcomes of those that have succeeded, by their names."""
        outcomes = {}
        run = dispatch(self.client, tasks, self.folder, self.slots, self.retries)
        try:
            for task, outcome in run:
                self.tries += outcome.tries
                if outcome.status != 0:
                    self.found.failures.append(Failure(task.name, outcome.status, outcome.message))
                else:
                    outcomes[task.name] = outcome
                    if publish:
                        self._publish(task, outcome)
                self.found.warnings.extend((task.name, text) for text in outcome.warnings)
                if outcome.worker:
                    self.found.workers[outcome.worker] = 1 + self.found.workers.get(
                        outcome.worker, 0)
                self.done += 1
                if self.progress:
                    self.progress(self.done, self.total, task.name)
                if outcome.status != 0 and not keep_going:
                    break
        finally:
            run.close()
        return outcomes

    def _publish(self, task: Task, outcome: Outcome) -> None:
        # What other files refer to comes first: the file of the output's own kind is the last.
        suffix = self.target.suffix.lower()
        for file in sorted(outcome.files, key=lambda name: name.lower().endswith(suffix)):
            path = pathlib.Path(file)
            place = self.target.parent / path.name
            if outcome.skipped:
                self.found.skipped.append(place)
                continue
            try:
                os.replace(path, place)
            except FileNotFoundError:
                self.found.failures.append(Failure(
                    task.name, -1, f"a worker has written '{path}', which is not to be seen here; "
                    "expected a folder that all machines share"))
                return
            self.found.written.append(place)

    def report(self) -> Report:
        return self.found._replace(tries=self.tries, seconds=time.monotonic() - self.start)


def _slots(threads: Optional[int], memory: Optional[int]) -> Slots:
    for name, value in (("threads", threads), ("memory", memory)):
        if value is not None and (not isinstance(value, numbers.Integral) or value < 1):
            raise ValueError(f"{name} is {value!r}; expected a whole number of 1 or more, or None")
    return Slots(threads, memory)


def _absolute(path: Path) -> str:
    """A name that holds on other machines; shapes have none."""
    name = os.fspath(path)
    return name if name.startswith("shape:") else os.path.abspath(name)


def option_words(options: Dict[str, Any]) -> List[str]:
    """Keywords as words of the command line: True is a flag, sequences have commas between. Files
    are named as they are on other machines."""
    reserved = {"output", "frames", "shard", "keep_going", "skip_existing", "threads", "quiet",
                "verbose", "progress", "stats", "help", "version"}
    files = {"like", "onto", "config", "camera_file", "environment"}
    words = []
    for keyword, value in options.items():
        if isinstance(value, os.PathLike) or (keyword in files and isinstance(value, str)):
            value = os.path.abspath(value)
        if keyword in reserved:
            raise ValueError(f"{keyword} is not an option of the command here; see the arguments")
        name = "--" + keyword.rstrip("_").replace("_", "-")
        if value is True:
            words.append(name)
        elif isinstance(value, (list, tuple)):
            words.append(name + "=" + ",".join(str(one) for one in value))
        elif value is not None and value is not False:
            words.append(f"{name}={value}")
    return words


def frame_numbers(frames: Union[str, Iterable[int]]) -> List[int]:
    """The numbers that 7, 1-100 or 1-100x2 stands for, as for --frames; each once."""
    if not isinstance(frames, str):
        return list(dict.fromkeys(frames))
    found = re.fullmatch(r"(\d+)(?:-(\d+)(?:x(\d+))?)?", frames)
    if not found or int(found[3] or 1) < 1 or int(found[2] or found[1]) < int(found[1]):
        raise ValueError(f"frames is '{frames}'; expected frames as in 7, 1-100 or 1-100x2")
    return list(range(int(found[1]), int(found[2] or found[1]) + 1, int(found[3] or 1)))


def with_frame(name: str, number: int) -> str:
    """The name with the number in its place: #### or %04d, filled up with zeros."""
    places = re.findall(r"#+|%0?\d*d", name)
    if len(places) != 1:
        return name
    place = places[0]
    width = len(place) if place[0] == "#" else int(place[1:-1] or 0)
    return name.replace(place, f"{number:0{width}d}" if width else str(number))
