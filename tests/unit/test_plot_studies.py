import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from rockflex.fragility import fit_clouds


def renamed(table, column, count):
    """As many copies of the first rows, each with another name."""
    return pd.concat([table[:6].assign(**{column: f"n{i}"}) for i in range(count)], ignore_index=True)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda cloud, *_: rf.plot_fragility([]),
            "clouds must be the table of a cloud study, or at least one fit of it from fit_clouds.",
        ),
        (
            lambda cloud, *_: rf.plot_fragility(cloud[:0]),
            "The table has no rows. Give what run_cloud returned.",
        ),
        (
            lambda cloud, *_: rf.plot_fragility(fit_clouds(cloud), "pga"),
            "The fits are of pgv, but 'pga' is to be shown. Fit the clouds with that one.",
        ),
        (
            lambda cloud, *_: rf.plot_fragility([*fit_clouds(cloud), *fit_clouds(cloud, "pga")]),
            "The fits are of pgv, pga, but one measure is to be shown. Fit the clouds with that one.",
        ),
        (
            lambda cloud, *_: rf.plot_fragility(fit_clouds(cloud), bins=4),
            "bins counts runs, but only fits were given. Give the table of the study.",
        ),
        (
            lambda cloud, *_: rf.plot_fragility(renamed(cloud, "structure", 13)),
            "13 structures are too many for one figure; 12 fit. Plot fewer at a time.",
        ),
        (
            lambda cloud, *_: rf.plot_clouds(cloud, "max_base_shear"),
            "quantity must be one of max_rotation, max_top_displacement, max_total_top_displacement, but "
            "'max_base_shear' was given.",
        ),
        (
            lambda cloud, *_: rf.plot_clouds(cloud, measure="pgw"),
            "The table lacks pgw. Give what run_cloud returned.",
        ),
        (
            lambda cloud, pairs, _: rf.plot_population(pairs.drop(columns="pgv")),
            "The table lacks pgv. Give what run_population returned.",
        ),
        (
            lambda cloud, pairs, _: rf.plot_agreement(pairs.assign(status_mdof=None)),
            "No pair was solved. See the column error of the table.",
        ),
        (
            lambda cloud, pairs, _: rf.plot_agreement(pairs.assign(aspect_ratio=np.arange(120.0))),
            "120 aspect ratios were given, but there are 15 symbols. Plot some of them.",
        ),
        (
            lambda cloud, pairs, _: rf.plot_modal_combination(pairs.drop(columns=["sd_2", "srss_base_shear"])),
            "The table lacks sd_2, srss_base_shear. Give what run_population returned.",
        ),
        (
            lambda cloud, pairs, _: rf.plot_ida(cloud),
            "The table lacks overturned, resurrections, first_overturning_scale, last_survival_scale. "
            "Give what run_incremental returned.",
        ),
        (
            lambda cloud, pairs, ladders: rf.plot_ida(renamed(ladders, "structure", 7)),
            "7 structures and models are too many for one figure; 6 fit. Plot fewer at a time.",
        ),
        (
            lambda cloud, *_: rf.plot_stripes(cloud),
            "The table lacks level. Give the table of a stripe study.",
        ),
        (
            lambda cloud, *_: rf.plot_stripes(cloud.assign(level=1.0, status=None)),
            "No run was solved. See the column error of the table.",
        ),
    ],
)
def test_what_cannot_be_drawn_is_named(cloud, pairs, ladders, call, message):
    with pytest.raises(rf.InputError) as caught:
        call(cloud, pairs, ladders)
    assert str(caught.value) == message
