"""How far a run is, told truly: what was kept from before is no work of this run."""

import dataclasses
import time


@dataclasses.dataclass
class Tally:
    """Counts of a run, in units of work.

    Attributes:
        unit: What they are, in the plural: ``texels`` or ``fits``.
        total: All of them.
        kept: Those found finished by an earlier run.
        done: Those finished by this one.
        not_converged: Those, kept and done, whose fit did not converge.
        failed: Those done that have a sentence instead of a result.
        begun: When this run began to work, on the clock of `time.perf_counter`: it
            moves on while all that is found is kept.
        seconds: Time that it has worked.
    """

    unit: str
    total: int
    kept: int = 0
    done: int = 0
    not_converged: int = 0
    failed: int = 0
    begun: float = dataclasses.field(default_factory=time.perf_counter)
    seconds: float = 0.0

    def add(
        self, units: int, *, kept: bool, not_converged: int = 0, failed: int = 0
    ) -> None:
        """Count units that are finished now."""
        now = time.perf_counter()
        if kept and not self.done:
            self.begun = now
        self.kept += units if kept else 0
        self.done += 0 if kept else units
        self.not_converged += not_converged
        self.failed += failed
        self.seconds = now - self.begun

    @property
    def share(self) -> float:
        """Share of all units that is finished."""
        return (self.kept + self.done) / self.total if self.total else 1.0

    @property
    def rate(self) -> float:
        """Units that this run finishes in a second; 0 before the first."""
        return self.done / self.seconds if self.done else 0.0

    @property
    def remaining(self) -> float | None:
        """Seconds that the rest takes at this rate; None before there is one."""
        left = self.total - self.kept - self.done
        return left / self.rate if self.rate else None

    @property
    def sentence(self) -> str:
        """What the run came to."""
        parts = [f"{self.kept + self.done:,} of {self.total:,} {self.unit} finished"]
        if self.kept:
            parts.append(f"{self.kept:,} kept from an earlier run")
        if self.done:
            parts.append(f"{self.done:,} done now, {self.rate:,.3g} per second")
        if self.not_converged:
            parts.append(f"{self.not_converged:,} did not converge")
        if self.failed:
            parts.append(f"{self.failed:,} failed")
        return f"{'; '.join(parts)}."
