"""Closed forms for bases that slide, hop, and stand on springs."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

GRAVITY = 9.81


def newmark_slip(acceleration: float, duration: float, friction: float, gravity: float = GRAVITY) -> float:
    """Slip of a rigid block under a rectangular pulse A of length t_1: (A t_1)²/(2 μ g) (1 - μ g/A) (Newmark 1965).

    The base is left behind at A - μ g, and brought to rest at μ g after the pulse.
    """
    grip = friction * gravity
    if acceleration <= grip:
        return 0.0
    return (acceleration * duration) ** 2 / (2.0 * grip) * (1.0 - grip / acceleration)


def newmark_duration(acceleration: float, duration: float, friction: float, gravity: float = GRAVITY) -> float:
    """Time from the begin of the pulse to the end of slip: A t_1/(μ g)."""
    return acceleration * duration / (friction * gravity)


@dataclass(frozen=True)
class Block:
    """A free-standing rigid block of half-width B, with its centre of mass at the height H (Shenton 1996).

    ``inertia`` is that about the centre over the mass; a homogeneous rectangular block has (B² + H²)/3.
    """

    half_width: float
    height: float
    inertia: float
    gravity: float = GRAVITY

    @property
    def about_edge(self) -> float:
        return self.inertia + self.half_width**2 + self.height**2

    def rock(self, a: float) -> float:
        """|θ''| of a block that starts to rock without slip, at the ground acceleration |a|."""
        return (self.height * a - self.gravity * self.half_width) / self.about_edge

    def rocks_above(self) -> float:
        """|a| above which a block that does not slip rocks: g B/H."""
        return self.gravity * self.half_width / self.height

    def friction_to_rock(self, a: float) -> float:
        """Friction that it needs to rock without slip: (|a| - H |θ''|)/(g + B |θ''|) (Shenton 1996)."""
        turn = self.rock(a)
        return (a - self.height * turn) / (self.gravity + self.half_width * turn)

    def slide_rock(self, friction: float, a: float) -> tuple[float, float]:
        """|θ''| and |x''| of a block that starts to rock and slide at once.

        From N = m (g + B θ''), horizontally |a| - |x''| - H |θ''| = μ N/m, and about the centre
        r² |θ''| = H μ N/m - B N/m.
        """
        lever = friction * self.height - self.half_width
        turn = lever * self.gravity / (self.inertia - lever * self.half_width)
        return turn, a - self.height * turn - friction * (self.gravity + self.half_width * turn)

    def begins(self, friction: float, a: float) -> str:
        """What begins from rest at the constant ground acceleration a: "rest", "slide", "rock" or "slide-rock"."""
        a = abs(a)
        tilts = friction > self.half_width / self.height  # sliding friction turns the block over
        if not tilts:
            return "slide" if a > friction * self.gravity else "rest"
        if a <= self.rocks_above():
            return "rest"
        return "rock" if self.friction_to_rock(a) <= friction else "slide-rock"


def homogeneous(half_width: float, height: float, gravity: float = GRAVITY) -> Block:
    """A homogeneous rectangular block 2B wide and 2H high."""
    return Block(half_width, height, (half_width**2 + height**2) / 3.0, gravity)


def shenton_friction(a_over_g: float, slenderness: float) -> float:
    """Friction that divides rock from slide-rock, ((4 + γ²) A + 3 γ)/(3 γ A + 1 + 4 γ²) with γ = H/B (Shenton 1996).

    For a homogeneous rectangular block, as `Block.friction_to_rock` gives it.
    """
    g = slenderness
    return ((4.0 + g**2) * a_over_g + 3.0 * g) / (3.0 * g * a_over_g + 1.0 + 4.0 * g**2)


def flight(speed: float, gravity: float = GRAVITY) -> tuple[float, float]:
    """Duration and height of the ballistic flight of a mass that leaves the ground upwards at `speed`."""
    return 2.0 * speed / gravity, 0.5 * speed**2 / gravity


def restitution(damping_ratio: float) -> float:
    """Restitution of a mass without weight on a spring-dashpot that never pulls (Schwager & Pöschel 2007).

    Contact ends where the force vanishes, at ω_d t = atan2(2 ζ (1 - ζ²)^½, 2 ζ² - 1), before the spring is at its
    length again; the speed is then e^(-ζ ω t) times that of the arrival. Above critical damping the functions become
    hyperbolic.
    """
    z = damping_ratio
    if z < 1.0:
        root = np.sqrt(1.0 - z**2)
        return float(np.exp(-z / root * np.arctan2(2.0 * z * root, 2.0 * z**2 - 1.0)))
    if z == 1.0:
        return float(np.exp(-2.0))
    root = np.sqrt(z**2 - 1.0)
    return float(np.exp(-z / root * np.log((z + root) / (z - root))))


@dataclass(frozen=True)
class Bounce:
    """Contact of a mass with a spring-dashpot: how long the force lasts, depth then, speed then, largest depth."""

    duration: float
    depth: float
    speed: float
    deepest: float


def bounce(
    speed: float, frequency: float, damping_ratio: float, gravity: float = GRAVITY, pressed: float = 0.0
) -> Bounce:
    """A mass that meets a spring-dashpot downwards at `speed`, until its force -k z - c z' vanishes; ζ < 1.

    The spring is already `pressed` by that length, or still unloaded. Raises ValueError if the mass does not leave.
    """
    w, z = frequency, damping_ratio
    if not 0.0 <= z < 1.0:
        msg = "the damping ratio must lie in [0, 1)"
        raise ValueError(msg)
    wd, rest = w * np.sqrt(1.0 - z**2), gravity / w**2
    c1 = rest - pressed
    c2 = (z * w * c1 - speed) / wd

    def place(t: float) -> float:  # heave
        return -rest + np.exp(-z * w * t) * (c1 * np.cos(wd * t) + c2 * np.sin(wd * t))

    def rate(t: float) -> float:
        swing = (wd * c2 - z * w * c1) * np.cos(wd * t) - (wd * c1 + z * w * c2) * np.sin(wd * t)
        return np.exp(-z * w * t) * swing

    def force(t: float) -> float:  # over the mass
        return -(w**2) * place(t) - 2.0 * z * w * rate(t)

    grid = np.linspace(0.0, 2.0 * np.pi / wd, 4001)[1:]
    pushes = np.array([force(t) for t in grid])
    if not (pushes < 0.0).any():
        msg = "the mass stays on the spring"
        raise ValueError(msg)
    i = int(np.argmax(pushes < 0.0))
    end = brentq(force, grid[i - 1] if i else 0.0, grid[i], xtol=1e-16, rtol=1e-15)
    low = brentq(rate, 0.0, end, xtol=1e-16, rtol=1e-15) if speed > 0.0 else 0.0
    return Bounce(float(end), float(-place(end)), float(rate(end)), float(-place(low)))


def two_springs(theta: float, weight: float, stiffness: float, arm: float) -> tuple[float, float]:
    """Moment of two springs k at ±b under a weight W about the middle of the base, and heave there; θ > 0.

    2 k b² θ until one spring is empty at W/(2 k b), W b from there on.
    """
    if theta <= weight / (2.0 * stiffness * arm):
        return 2.0 * stiffness * arm**2 * theta, -0.5 * weight / stiffness
    return weight * arm, -weight / stiffness + arm * theta


def bed(theta: float, weight: float, modulus: float, half_width: float) -> tuple[float, float]:
    """Moment of a continuous bed under a weight W about the middle of the base, and heave there; θ > 0.

    `modulus` is the stiffness in N/m per m of width. Full contact up to θ = W/(2 K B²) with the moment 2/3 K B³ θ;
    then a triangle of pressure of the length c = (2 W/(K θ))^½ remains, and M = W (B - c/3) (Yim & Chopra 1984).
    """
    if theta <= weight / (2.0 * modulus * half_width**2):
        return 2.0 / 3.0 * modulus * half_width**3 * theta, -0.5 * weight / (modulus * half_width)
    length = np.sqrt(2.0 * weight / (modulus * theta))
    return weight * (half_width - length / 3.0), (half_width - length) * theta
