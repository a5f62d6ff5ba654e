"""One run over the tasks of a folder: do, record, count, and stop with a sentence."""

import dataclasses
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing

from brdffit.batch.cluster import Item, outcomes
from brdffit.batch.ledger import Ledger, Record
from brdffit.batch.tally import Tally
from brdffit.files import sentence


@dataclasses.dataclass(frozen=True)
class Outcome:
    """What a task came to.

    Attributes:
        key: Which task.
        units: Texels or fits in it.
        record: For the ledger; None when there is no result.
        kept: True when an earlier run had finished it.
        failure: Why there is no result, as a sentence.
    """

    key: str
    units: int
    record: Record | None
    kept: bool = False
    failure: str = ""


def run(
    task: Callable[[Item], Outcome],
    items: Iterable[Item],
    ledger: Ledger,
    tally: Tally,
    cluster: str | None,
    on_progress: Callable[[Tally], None] | None,
) -> Iterator[Outcome]:
    """Outcomes as they come, each in the ledger before it is counted and handed on.

    Raises:
        KeyboardInterrupt: The run was interrupted; says what is kept and how to go on.
        ConnectionError: The scheduler is not there, or went away.
        OSError: Something cannot be read or written; with the same words.
    """
    try:
        with closing(outcomes(task, items, cluster)) as stream:
            for outcome in stream:
                facts = {}
                if outcome.record is not None:
                    facts = outcome.record.facts
                    if not outcome.kept:
                        ledger.commit(outcome.record)
                tally.add(
                    outcome.units,
                    kept=outcome.kept,
                    not_converged=facts.get("not_converged", 0),
                    failed=0 if outcome.record else outcome.units,
                )
                if on_progress:
                    on_progress(tally)
                yield outcome
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"Interrupted. {_kept(ledger, tally)}") from None
    except OSError as error:
        raise type(error)(f"{sentence(error)} {_kept(ledger, tally)}") from error


def _kept(ledger: Ledger, tally: Tally) -> str:
    """What a run that ends early leaves, and how to go on."""
    return (
        f"{tally.kept + tally.done - tally.failed:,} of {tally.total:,} {tally.unit} "
        f"are finished and kept in `{ledger.path.parent}`: go on with --resume (in "
        "Python, resume=True)."
    )
