"""Times at which a motion can be evaluated, for pictures that choose their own."""

from andoyer._core import Motion


def within_span(motion: Motion, start: float, stop: float) -> tuple[float, float]:
    """An interval that begins at the epoch and in which the motion can be evaluated. For an integrated motion it ends with the span, or is the span if the span ends at the epoch."""
    span = motion.scene.span
    if motion.plan.method != "integrated" or span is None:
        return start, stop
    stop = min(stop, span[1])
    return (start, stop) if stop > start else (span[0], start)
