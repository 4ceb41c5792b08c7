"""Table 3 and the finite element values of Section 4.1.1: the modes of the chimney."""

from dataclasses import replace

from rockflex.papers.silva_stojadinovic_2024._number import compared
from rockflex.papers.silva_stojadinovic_2024._printed import range_of
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._slices import first_frequency, ritz_of_slices
from rockflex.papers.silva_stojadinovic_2024._structures import TOWER
from rockflex.papers.silva_stojadinovic_2024._verdict import Kind
from rockflex.report import Number, Remark, Result

TITLE = "Modes of the chimney, by Rayleigh-Ritz and by 2000 finite elements"
RITZ = {
    "ω": (("1.66", "7.76", "19.94", "38.14", "62.74"), "rad/s"),
    "m*": (("8.48", "3.32", "1.39", "0.75", "0.52"), "10⁶ kg"),
    "h*": (("141.63", "51.33", "31.40", "22.51", "17.25"), "m"),
    "Γ": (("1.73", "−1.19", "0.81", "−0.60", "0.47"), ""),
}

SLICES = (200, 2000, 4000, 5600, 6250, 6800, 8000, 20_000)
ELEMENTS = (500, 1000, 2000)
PLACES = {"lower end": 0.0, "upper end": 1.0}


def reproduce(_: Records) -> Result:
    """Compute both sets of modes."""
    note = (
        "The table rounds some values and cuts others off, as noted in each line. The Ritz values are from one "
        "solution with the five functions of Eq. 36; iterations would approach the finite element values."
    )
    numbers = (*_ritz(), *_elements())
    return Result("table-3", TITLE, numbers, note=note, remarking=(_thin_slices, _rounding))


def _ritz() -> list[Number]:
    p = TOWER.rocking()
    ours = {"ω": p.omega, "m*": p.effective_mass / 1e6, "h*": p.effective_height, "Γ": p.top_ordinate}
    return [
        compared(
            f"{name}_{n}", f"Table 3, mode {n}", printed, ours[name][n - 1], unit, truncated=True,
        )
        for n in range(1, 6)
        for name, (row, unit) in RITZ.items()
        for printed in (row[n - 1],)
    ]  # fmt: skip


def _elements() -> list[Number]:
    p = replace(TOWER, method="fe").rocking()
    mass, height, lever = p.effective_mass, p.effective_height, p.effective_mass * p.effective_height
    own = "Table 3 has 1.66 by Ritz, from above: so many finite elements cannot give more"
    found = (
        ("m*_1", "8.485", mass[0] / 1e6, "10⁶ kg", ""),
        ("h*_1", "141.66", height[0], "m", ""),
        ("ω_1", "1.678", p.omega[0], "rad/s", own),
        ("Γ_1", "1.725", p.top_ordinate[0], "", ""),
        ("m*_1/m_tot", "0.51", mass[0] / p.m_tot, "", ""),
        ("m*_1 h*_1/L_0^r", "0.82", lever[0] / p.l0r, "", ""),
        ("m*_2", "3.233", mass[1] / 1e6, "10⁶ kg", ""),
        ("h*_2", "50.02", height[1], "m", "Table 3 has 51.33 by Ritz"),
        ("ω_2", "7.75", p.omega[1], "rad/s", ""),
        ("Γ_2", "−1.179", p.top_ordinate[1], "", ""),
        ("(m*_1 + m*_2)/m_tot", "0.71", mass[:2].sum() / p.m_tot, "", ""),
        ("(m*_1 h*_1 + m*_2 h*_2)/L_0^r", "0.94", lever[:2].sum() / p.l0r, "", ""),
    )
    return [
        compared(f"{name}, finite elements", "Section 4.1.1", printed, float(value), unit, note=note)
        for name, printed, value, unit, note in found
    ]


def _thin_slices() -> Remark:
    """Count the entries of the table that a Ritz solution with slices meets by rounding."""
    rows: list[tuple[str, ...]] = []
    for slices in SLICES:
        ours = ritz_of_slices(slices)
        met = sum(
            float(value) in range_of(text)
            for name, (row, _) in RITZ.items()
            for text, value in zip(row, ours[name], strict=True)
        )
        rows.append((str(slices), f"{TOWER.height / slices:.4f}", f"{met} of 20", f"{ours['h*'][1]:.3f}"))
    exact = sum(line.ours in range_of(line.printed) for line in _ritz())
    return Remark(
        Kind.AFTERWARDS,
        "Sums over thin slices in place of integrals",
        "The five functions of Eq. 36, with stiffness taken at the upper end of each slice and mass by the trapezoidal "
        f"rule. With slices of about 0.03 m every entry of the table rounds to what is printed, h*_2 too; with the "
        f"integrals {exact} of 20 do.",
        ("slices", "height of a slice, m", "entries met by rounding", "h*_2, m (printed 51.33)"),
        rows,
    )


def _rounding() -> Remark:
    """Show how much rounding errors change ω_1 of finite elements."""
    found = {n: [first_frequency(n, place) for place in PLACES.values()] for n in ELEMENTS}
    robust = float(replace(TOWER, method="fe").rocking().omega[0])
    low, high = min(found[ELEMENTS[-1]]), max(found[ELEMENTS[-1]])
    return Remark(
        Kind.BESIDE,
        "ω_1 of finite elements without precautions against rounding",
        "Cubic elements in plain double precision, with dense matrices and a general eigenvalue solver; the stiffness "
        "of an element is sampled at one place, which by itself changes ω_1 by less than 0.1 % from 1000 elements on. "
        "But the largest eigenvalue over the least grows as the fourth power of their number, and rounding with it. "
        f"With {ELEMENTS[-1]} elements ω_1 is from {low:.3f} to {high:.3f} rad/s here, and differs on other machines; "
        f"without these errors it is {robust:.4f}. The printed 1.678 may be such a value, or not.",
        ("elements", *(f"stiffness at the {name}, ω_1 in rad/s" for name in PLACES)),
        [(str(n), *(f"{value:.4f}" for value in values)) for n, values in found.items()],
    )
