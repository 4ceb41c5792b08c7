"""What remarks of the report rest on: sums over slices, plain finite elements, and both signs of Eq. 22."""

import pandas as pd
import pytest

from rockflex.papers.silva_stojadinovic_2024._inputs import TOWER
from rockflex.papers.silva_stojadinovic_2024._section_3_2 import friction_intervals
from rockflex.papers.silva_stojadinovic_2024._section_4 import RITZ, first_frequency, ritz_of_slices


def test_sliding_by_both_signs():
    """Ratios and counts of made-up runs, as medians by hand give them."""
    medians = {"#1": 0.2, "#2": 0.1, "#3": 0.3, "#4": 0.2, "#5": 0.5, "#6": 1.5}
    rows = [
        {"model": "2DOF-C", "structure": name, "group": f"{group}", "printed": value, "mended": 0.3 - 0.1 * value}
        for name, value in medians.items() for group in range(4)
    ]  # fmt: skip
    runs = pd.DataFrame(rows)
    printed, mended = (friction_intervals(runs, "2DOF-C", sign) for sign in ("printed", "mended"))
    assert printed["shear over flexure"].estimate == pytest.approx(0.5 / 1.5)
    assert printed["h*_1/B = 5 over 10"].estimate == pytest.approx(2.5)
    assert printed["T_1 = 0.5 s over 1 s"].estimate == pytest.approx(1.5)
    assert printed["runs that need more than 1.0"].estimate == 4.0
    assert mended["shear over flexure"].estimate == pytest.approx(0.27 / 0.28)
    assert mended["runs that need more than 1.0"].estimate == 0.0


def test_thin_slices_meet_every_entry_of_table_3():
    def missed(slices):
        ours = ritz_of_slices(slices)
        return [
            (name, n) for name, (row, _) in RITZ.items() for n, text in enumerate(row)
            if f"{ours[name][n]:.2f}" != text.replace("−", "-")
        ]  # fmt: skip

    assert all(not missed(round(200 / height)) for height in (0.029, 0.032, 0.036))
    assert ("h*", 1) in missed(40_000)
    exact, fine = TOWER.rocking(), ritz_of_slices(400_000)
    for name, values in (("ω", exact.omega), ("m*", exact.effective_mass / 1e6), ("h*", exact.effective_height)):
        assert fine[name] == pytest.approx(values, rel=2e-4)
    assert fine["Γ"] == pytest.approx(exact.top_ordinate, rel=2e-4)


def test_plain_finite_elements_converge_before_rounding_grows():
    """With few elements rounding is far below what sampling the stiffness at one place does, of the first order."""
    exact = TOWER.rocking().omega[0]
    low, high = ([first_frequency(n, place) / exact - 1 for n in (25, 50, 100)] for place in (0.0, 1.0))
    assert all(value > 0 for value in low)
    assert all(value < 0 for value in high)
    for errors in (low, high):
        assert [errors[0] / errors[1], errors[1] / errors[2]] == pytest.approx([2.0, 2.0], rel=0.05)
    assert first_frequency(100, 0.5) == pytest.approx(exact, rel=1e-4)
