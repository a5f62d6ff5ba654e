"""How a solve ended: a number in programs, words for people."""

STATUS = (
    "converged",
    "stopped at the largest number of steps before it converged",
    "stopped at a value that is not finite",
)
CONVERGED = 0  # place of success in `STATUS`


def sentence(outcome: int, steps: int) -> str:
    """An outcome in words, without the full stop."""
    return f"The fit {STATUS[outcome]} after {steps} steps"
