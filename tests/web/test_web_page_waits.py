"""Choices on the page before the server has answered: suggestions suit the structure that is shown in the end."""

import pytest

from rockflex.structure.file import StructureEntry
from rockflex.web._presets import PRESETS
from rockflex.web._structures import build

pytestmark = pytest.mark.web


class Held:
    """Requests, about structures if nothing else is said, which wait for `release`."""

    def __init__(self, page, path: str = "structure") -> None:
        self.routes, self.open = [], False
        page.route(f"**/api/{path}", self.take)

    def take(self, route) -> None:
        if self.open:
            route.continue_()
        else:
            self.routes.append(route)

    def release(self) -> None:
        self.open = True
        for route in self.routes:
            route.continue_()


@pytest.mark.parametrize("kind", ["springs", "winkler"])
def test_new_springs_wait_for_the_structure_they_suit(visitor, kind) -> None:
    """Answers that are held back: neither no structure nor the previous one may be taken for the present one."""
    page = visitor.page
    page.wait_for_selector("#view dl.values")
    held = Held(page)
    chimney = next(i for i, each in enumerate(PRESETS) if "chimney" in each["title"].lower())
    page.get_by_label("Start from").select_option(str(chimney))
    page.get_by_label("Ground", exact=True).select_option(kind)
    page.wait_for_timeout(100)
    assert "ground" not in visitor.state()
    held.release()
    page.wait_for_selector("#springs")
    p = build(StructureEntry.model_validate(PRESETS[chimney]["structure"])).properties
    ground = visitor.state()["ground"]
    assert ground["mat_mass"] == float(f"{0.1 * p.m_tot:.2g}")
    stiffness = p.m_tot * 9.81 / 0.005
    if kind == "springs":
        assert ground["springs"]["stiffness"] == float(f"{stiffness / 2:.2g}")
    else:
        breadth = float(f"{2 * p.half_width:.2g}")
        assert ground["bed"]["subgrade_modulus"] == float(f"{stiffness / (2 * p.half_width * breadth):.2g}")


def test_the_last_choice_of_a_ground_counts_while_the_structure_is_awaited(visitor) -> None:
    page = visitor.page
    held = Held(page)
    page.reload()
    ground = page.get_by_label("Ground", exact=True)
    ground.select_option("springs")
    ground.select_option("")
    held.release()
    page.wait_for_selector("#view dl.values")
    assert "ground" not in visitor.state()
    visitor.fill("structure.frame.aspect_ratio", "-1")
    page.wait_for_selector(".results.stale")
    ground.select_option("springs")  # of a structure that cannot be built: usual numbers, to be changed
    page.wait_for_function("() => rockflexPage.state.ground !== undefined")
    assert visitor.state()["ground"]["mat_mass"] == 2e4


@pytest.mark.parametrize("linked", [False, True])
@pytest.mark.parametrize("keys", [False, True])
def test_a_tab_chosen_before_the_page_knows_its_state_is_shown(visitor, linked, keys) -> None:
    page = visitor.page
    link = page.evaluate("location.hash") if linked else ""
    page.goto("about:blank")
    about = Held(page, "about")
    page.goto(f"{visitor.url}/{link}", wait_until="commit")
    if keys:
        page.locator('[data-tab="structure"]').focus()
        for _ in range(3):
            page.keyboard.press("ArrowRight")
        page.keyboard.press("ArrowLeft")
    else:
        page.locator('[data-tab="fragility"]').click()
        page.locator('[data-tab="response"]').click()
    about.release()
    page.wait_for_selector('#view[data-shown="response"]')
    assert visitor.state()["tab"] == "response"
    page.locator('[data-tab="earthquake"]').click()  # and the next choice is not overruled
    page.wait_for_selector('#view[data-shown="earthquake"]')
