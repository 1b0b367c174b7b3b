"""Hands runs of the command to the workers of a Dask cluster, as many to each as it has room for."""

from __future__ import annotations

import collections
import importlib
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import uuid
from typing import Any, Deque, Dict, Generator, List, NamedTuple, Optional, Sequence, Set, Tuple

# How often the workers are looked at, and whether the call is still going on; seconds.
INTERVAL = 0.5
# For how long there may be no worker that is large enough, before that is an error.
PATIENCE = 60.0
# The statuses of the command that another try may change: failed while running, out of memory.
WORTH_ANOTHER_TRY = (1, 5)


class Task(NamedTuple):
    """One run of the command, but for --output and --threads."""

    name: str
    key: str  # what Dask shows; tasks whose letters are the same are of one kind there
    words: Tuple[str, ...]
    output: str  # name of the file, without a folder
    existing: str = ""  # a file to be left alone if doing it again would give the same


class Outcome(NamedTuple):
    """What has become of a run."""

    status: int  # exit status; 128 + s after signal s, -1 if it did not come to run
    message: str
    warnings: Tuple[str, ...] = ()
    files: Tuple[str, ...] = ()
    skipped: bool = False
    worker: str = ""
    tries: int = 1


class Slots(NamedTuple):
    """What a task takes of a worker."""

    threads: Optional[int]  # None: all of them
    memory: Optional[int]  # bytes; None: does not matter

    def of(self, nthreads: int, memory_limit: int) -> int:
        """How many tasks a worker takes at a time; a limit of 0 is none."""
        count = 1 if self.threads is None else nthreads // self.threads
        if self.memory and memory_limit:
            count = min(count, memory_limit // self.memory)
        return count

    def text(self) -> str:
        needs = []
        if self.threads is not None:
            needs.append(f"{self.threads} threads")
        if self.memory:
            needs.append(f"{self.memory} bytes of memory")
        return " and ".join(needs) or "any worker"


def _dask() -> Any:
    """The package, which the rest of Bandvox does without, and so do type checkers."""
    return importlib.import_module("distributed")


def attempt(task: Task, folder: str, threads: Optional[int]) -> Outcome:
    """Run the command here, on a worker, in a folder of its own in `folder`."""
    worker = _dask().get_worker()
    place = pathlib.Path(folder, uuid.uuid4().hex)
    try:
        place.mkdir()
    except OSError as error:
        return Outcome(-1, f"{error.strerror}: '{place}'; expected a folder that all machines "
                       "share", worker=worker.address)
    nthreads = getattr(worker, "state", worker).nthreads
    words = list(task.words) + ["--output", str(place / task.output), "--quiet",
                                "--threads", str(threads or nthreads)]
    before = None
    if task.existing:
        words.append("--skip-existing")
        before = _bring(pathlib.Path(task.existing), place)
    # The command ends with the worker.
    if shutil.which("setpriv"):
        words = ["setpriv", "--pdeathsig", "TERM", "--", *words]
    # Not a pipe: that would stay open as long as anything that the command has started runs.
    with tempfile.TemporaryFile("w+", errors="replace") as said:
        try:
            process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                       stderr=said, start_new_session=True)
        except OSError as error:
            return Outcome(-1, f"cannot run '{words[0]}': {error.strerror}", worker=worker.address)
        while True:
            try:
                process.wait(timeout=INTERVAL)
                break
            except subprocess.TimeoutExpired:
                if not os.path.isdir(folder):  # nobody waits for it
                    os.killpg(process.pid, signal.SIGTERM)
        said.seek(0)
        text = said.read()
    status = process.returncode if process.returncode >= 0 else 128 - process.returncode
    return _outcome(status, text, place, before, worker.address)


def _bring(existing: pathlib.Path, place: pathlib.Path) -> Optional[Tuple[int, int]]:
    """Put a file that is there into the folder of a run; returns what tells it from a new one."""
    copy = place / existing.name
    try:
        os.link(existing, copy)
    except FileNotFoundError:
        return None
    except OSError:
        shutil.copy2(existing, copy)
    return _mark(copy)


def _mark(file: pathlib.Path) -> Tuple[int, int]:
    found = file.stat()
    return found.st_ino, found.st_mtime_ns


def _outcome(status: int, said: str, place: pathlib.Path, before: Optional[Tuple[int, int]],
             worker: str) -> Outcome:
    lines = [line.partition("bandvox: ")[2] or line for line in said.splitlines() if line.strip()]
    warnings = tuple(line.partition("warning: ")[2] or line for line in lines
                     if not line.startswith("error: "))
    if status != 0:
        message = lines[-1] if lines else f"the command has ended with status {status}"
        if message.startswith("error: "):
            message = message[len("error: "):]
        shutil.rmtree(place, ignore_errors=True)
        return Outcome(status, message, warnings, worker=worker)
    files = sorted(path for path in place.iterdir() if not path.name.startswith("."))
    skipped = before is not None and len(files) == 1 and _mark(files[0]) == before
    return Outcome(0, "", warnings, tuple(str(path) for path in files), skipped, worker)


class _Waiting:
    """Tasks that wait for their turn, as Dask's dashboard shows them. Dask does not get a task before
    there is room for it on a worker; without these it would take what it has for all there is."""

    def __init__(self, client: Any, tasks: Sequence[Task]) -> None:
        self.client = client
        # No worker has this address, so it never runs, and what depends on it waits.
        self.gate = client.submit(bool, workers=["tcp://0.0.0.0:0"], pure=False,
                                  key=f"bandvox-free-worker-{uuid.uuid4().hex}")
        self.futures = dict(zip((task.name for task in tasks), client.map(
            bool, [self.gate] * len(tasks), key=[self.key(task) for task in tasks])))

    @staticmethod
    def key(task: Task) -> str:
        return f"{task.key}-{uuid.uuid4().hex}-waiting"

    def add(self, task: Task) -> None:
        self.futures[task.name] = self.client.submit(bool, self.gate, key=self.key(task))

    def remove(self, task: Task) -> None:
        self.futures.pop(task.name).release()

    def close(self) -> None:
        self.client.cancel([self.gate, *self.futures.values()])


class _Dispatcher:
    def __init__(self, client: Any, tasks: Sequence[Task], folder: pathlib.Path, slots: Slots,
                 retries: int) -> None:
        self.client, self.folder, self.slots, self.retries = client, folder, slots, retries
        self.waiting: Deque[Task] = collections.deque(tasks)
        self.shown = _Waiting(client, tasks)
        self.running: Dict[Any, Tuple[Task, str]] = {}
        # What the workers have done. As long as it is kept, the dashboard counts it.
        self.done: Dict[Any, str] = {}
        self.tries: Dict[str, int] = collections.Counter()
        # Where a task has failed: if there is a choice it is tried elsewhere.
        self.failed_at: Dict[str, Set[str]] = {}
        self.suitable: List[str] = []
        self.lost: List[Tuple[Task, Outcome]] = []
        self.last_seen = time.monotonic()

    def room(self) -> Dict[str, int]:
        """How many more tasks each worker takes, the largest workers first."""
        workers = self.client.scheduler_info()["workers"]
        found = {address: self.slots.of(one["nthreads"], one["memory_limit"] or 0)
                 for address, one in sorted(workers.items(),
                                            key=lambda item: -int(item[1]["nthreads"]))}
        if any(count > 0 for count in found.values()):
            self.last_seen = time.monotonic()
        elif time.monotonic() - self.last_seen > PATIENCE or (workers and not self.tries):
            largest = max((one["nthreads"] for one in workers.values()), default=0)
            memory = max((one["memory_limit"] or 0 for one in workers.values()), default=0)
            raise ValueError(f"no worker is large enough: a task takes {self.slots.text()}; found "
                             f"{len(workers)} workers, with at most {largest} threads and {memory} "
                             "bytes of memory")
        self.suitable = [address for address, count in found.items() if count > 0]
        self.take_back_lost(workers)
        for _, address in self.running.values():
            if address in found:
                found[address] -= 1
        return found

    def take_back_lost(self, workers: Dict[str, Any]) -> None:
        # Dask would do again what a worker has done that was lost and comes back.
        self.done = {future: address for future, address in self.done.items() if address in workers}
        for future, (task, address) in list(self.running.items()):
            if address not in workers and not future.done():
                del self.running[future]
                future.cancel()
                # The task may be what its workers die of.
                if self.tries[task.name] > self.retries:
                    self.lost.append((task, Outcome(-1, f"the worker {address} was lost",
                                                    tries=self.tries[task.name])))
                else:
                    self.waiting.appendleft(task)
                    self.shown.add(task)

    def assign(self) -> None:
        room = self.room()
        # One to each before any gets a second one.
        while self.waiting and any(count > 0 for count in room.values()):
            for address in [address for address, count in room.items() if count > 0]:
                task = self.next_for(address)
                if task is None:
                    room[address] = 0
                    continue
                room[address] -= 1
                self.tries[task.name] += 1
                future = self.client.submit(
                    attempt, task, str(self.folder), self.slots.threads, workers=[address],
                    key=f"{task.key}-{uuid.uuid4().hex}", pure=False)
                self.running[future] = task, address
                self.shown.remove(task)

    def next_for(self, address: str) -> Optional[Task]:
        for task in self.waiting:
            failed = self.failed_at.get(task.name, set())
            if address not in failed or failed.issuperset(self.suitable):
                self.waiting.remove(task)
                return task
        return None

    def finish(self, future: Any) -> Optional[Tuple[Task, Outcome]]:
        task, address = self.running.pop(future)
        if future.status == "finished":
            outcome = future.result()
        else:
            error = future.exception() if future.status == "error" else None
            outcome = Outcome(-1, str(error or f"Dask has {future.status} it"), worker=address)
        outcome = outcome._replace(tries=self.tries[task.name])
        may_change = outcome.status in (-1, *WORTH_ANOTHER_TRY) or outcome.status > 128
        if may_change and self.tries[task.name] <= self.retries:
            self.failed_at.setdefault(task.name, set()).add(address)
            self.waiting.append(task)
            self.shown.add(task)
            return None
        self.done[future] = address
        return task, outcome

    def run(self) -> Generator[Tuple[Task, Outcome], None, None]:
        dask = _dask()
        try:
            while self.waiting or self.running:
                self.assign()
                yield from self.lost
                self.lost.clear()
                if not self.running:
                    time.sleep(INTERVAL)
                    continue
                try:
                    dask.wait(list(self.running), timeout=INTERVAL, return_when="FIRST_COMPLETED")
                except dask.TimeoutError:
                    continue
                except dask.CancelledError:
                    pass  # finish() tells which
                for future in [one for one in self.running if one.done()]:
                    finished = self.finish(future)
                    if finished:
                        yield finished
        finally:
            self.shown.close()
            self.client.cancel([*self.running, *self.done])


def dispatch(client: Any, tasks: Sequence[Task], folder: pathlib.Path, slots: Slots,
             retries: int) -> Generator[Tuple[Task, Outcome], None, None]:
    """Run all tasks, and give each with its outcome as soon as that is known. Closing it ends all.

    Not Dask but this chooses the worker: a task takes all of a small worker or a part of a large one,
    and the next one goes to whoever is done first. What a lost worker had is begun again elsewhere.
    """
    return _Dispatcher(client, tasks, folder, slots, retries).run()
