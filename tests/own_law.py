"""An impact law of a user's own, in a module that workers can import."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Lossy:
    """Keeps a share of what Eq. 25 keeps."""

    share: float = 0.9
    keeps = "a share of the horizontal velocities"
    loses = "the rest of them, and the rotation"

    def after(self, properties, modal_velocity, rotation_velocity):
        return self.share * (modal_velocity + properties.effective_height * rotation_velocity), 0.0
