"""Times at which a motion can be evaluated, for pictures that choose their own."""

from andoyer._core import Motion


def within_span(motion: Motion, start: float, stop: float) -> tuple[float, float]:
    """An interval that begins at the epoch, as far as the motion reaches: an integrated one ends with its span. Where the span ends at the epoch, the span itself."""
    span = motion.scene.span
    if motion.plan.method != "integrated" or span is None:
        return start, stop
    stop = min(stop, span[1])
    return (start, stop) if stop > start else (span[0], start)
