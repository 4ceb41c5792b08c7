"""How a run ends, or why it is interrupted; every failure includes its message."""

from enum import IntEnum


class Status(IntEnum):
    """The status of a run; negative values are failures, with a message and a remedy.

    The placeholders in the texts are the `label` of the model, the impact `law`, and the `time` in s.
    """

    what: str
    mend: str

    def __new__(cls, value: int, what: str = "", mend: str = "") -> "Status":
        """Create a member that is a number."""
        member = int.__new__(cls, value)
        member._value_ = value
        member.what, member.mend = what, mend
        return member

    ENDED = 0
    OVERTURNED = 1
    SETTLED = 2
    PAUSED = 3  # the slice of work is used up, or the history is full; the run continues at the next call
    LACKS_PHASE = 4  # the run enters a phase that is not compiled yet; it continues once it is
    BROKEN = -1, "The impact law {law} failed", ""
    CHATTER = (
        -2,
        "The events of {label}, such as impacts, accumulate without end in the sample before {time:.6g} s.",
        "Check the model's parameters, and refine the record.",
    )
    GAINED = (
        -3,
        "The impact law {law} returns energy in the sample before {time:.6g} s.",
        "A law can only lose energy: correct its `after`, or lower its restitution.",
    )
    STALLED = (
        -4,
        "The motion of {label} cannot be integrated in the sample before {time:.6g} s: no step is short enough.",
        "Check the parameters.",
    )
    UNSETTLED = (
        -5,
        "The free vibration of {label} has not settled {time:.6g} s after the start.",
        "Give free_vibration in seconds, or more damping.",
    )
    INFINITE = -6, "The motion of {label} is not finite at {time:.6g} s.", "Check the parameters."
