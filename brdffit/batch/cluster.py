"""The same tasks, done by threads of this process or by the workers of a Dask cluster.

A task is a function of one small item, path and index, and what it returns is small as
well: it reads its input and writes its output itself. So the two ways give the same
numbers, and nothing big goes through a scheduler.
"""

import functools
import pickle
import queue
import threading
from collections.abc import Callable, Generator, Iterable
from itertools import islice
from typing import Any, TypeVar

from brdffit.processor import cores

Item = TypeVar("Item")
Outcome = TypeVar("Outcome")

AHEAD = 3  # tasks that a cluster is given for each of its threads
LARGEST = 100_000  # bytes of a task that a scheduler may be given
TIMEOUT = 10  # seconds to reach a scheduler


def outcomes(
    task: Callable[[Item], Outcome], items: Iterable[Item], cluster: str | None = None
) -> Generator[Outcome]:
    """What the task makes of every item, as it comes.

    Args:
        task: Called in several threads at once, or, on a cluster, in other processes:
            then it must be small when pickled.
        items: What to do, taken up only when there is somebody to do it.
        cluster: Address of a Dask scheduler, or None for threads of this process, one
            for each core: XLA releases the lock of the interpreter.

    Raises:
        ConnectionError: There is no scheduler at the address, or it went away.
        ChildProcessError: A task kills one worker of a cluster after the other.
        ValueError: A task is too large to be sent to a cluster.
        Exception: Whatever a task raised first; no other task is begun then.
    """
    if cluster is None:
        return _by_threads(task, items, cores())
    return _by_workers(task, items, cluster)


def _by_threads(
    task: Callable[[Item], Outcome], items: Iterable[Item], count: int
) -> Generator[Outcome]:
    """Threads that a stop of the program need not wait for."""
    waiting, lock, stop = iter(items), threading.Lock(), threading.Event()
    done: queue.SimpleQueue[Callable[[], Outcome] | None] = queue.SimpleQueue()

    def work() -> None:
        while not stop.is_set():
            with lock:
                item = next(waiting, stop)
            if item is stop:
                break
            done.put(_attempt(task, item))  # pyright: ignore[reportArgumentType]
        done.put(None)

    threads = [threading.Thread(target=work, daemon=True) for _ in range(count)]
    for thread in threads:
        thread.start()
    try:
        working = count
        while working:
            outcome = done.get()
            if outcome is None:
                working -= 1
            else:
                yield outcome()
    except Exception:
        stop.set()
        for thread in threads:
            thread.join()
        raise
    finally:
        stop.set()


def _attempt(task: Callable[[Item], Outcome], item: Item) -> Callable[[], Outcome]:
    """A function that returns what the task returned, or raises what it raised."""
    try:
        outcome = task(item)
    except Exception as error:  # whatever it is, the caller is to see it
        return functools.partial(_raise, error)
    return lambda: outcome


def _raise(error: Exception) -> Any:
    raise error


def _by_workers(
    task: Callable[[Item], Outcome], items: Iterable[Item], address: str
) -> Generator[Outcome]:
    """Tasks on a cluster, never more at once than keep its threads busy."""
    size = len(pickle.dumps(task))
    if size > LARGEST:
        raise ValueError(
            f"A task for a cluster must be small, but has {size:,} bytes: write what "
            "it works on to a disk that all workers see, and name the path."
        )
    client = _connect(address)
    from distributed import KilledWorker, as_completed

    completed = as_completed(loop=client.loop, with_results=True)
    waiting = iter(items)

    def submit(count: int) -> None:
        for item in islice(waiting, count):
            completed.add(client.submit(_on_worker, task, item, pure=False))

    try:
        submit(AHEAD * max(sum(client.nthreads().values()), 1))
        for future, outcome in completed:
            if future.status == "cancelled":
                raise ConnectionError(f"The Dask scheduler at `{address}` went away.")
            submit(1)
            yield outcome
    except KilledWorker as error:
        raise ChildProcessError(
            f"A task has killed {error.allowed_failures + 1} workers of the cluster, "
            "most likely for want of memory; their logs say more."
        ) from error
    finally:
        client.close(timeout=1)


def _connect(address: str) -> Any:
    """A client of the scheduler at an address."""
    try:
        from distributed import Client
    except ModuleNotFoundError as missing:
        raise ValueError(
            f"A cluster needs the package {missing.name}, which is not installed: "
            "pip install 'brdffit[cluster]'."
        ) from missing
    try:
        return Client(address, timeout=TIMEOUT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ConnectionError(
            f"There is no Dask scheduler at `{address}`: {error}."
        ) from error


def _on_worker(task: Callable[[Item], Outcome], item: Item) -> Outcome:
    _keep_programs()
    return task(item)


@functools.cache
def _keep_programs() -> None:
    """Let the workers of one machine compile each program once between them."""
    from brdffit.cache import enable_compilation_cache

    enable_compilation_cache()
