"""Fragility and risk: regressions of study results, their confidence bands, and their integrals over hazard."""

from rockflex.fragility._annual_rate import AnnualRate, annual_rate, hazard_quadrature, risk_targeted_median
from rockflex.fragility._bootstrap import BootstrapBand, bootstrap_band, bootstrap_weights, resampled_exceedance
from rockflex.fragility._cloud import CloudFit, compare_measures, fit_cloud
from rockflex.fragility._clouds import CloudFits, fit_clouds, fit_each_cloud, recordings_of_runs
from rockflex.fragility._exports import write_nrml, write_pelicun
from rockflex.fragility._hazard import HazardCurve, measure_damping_of_runs
from rockflex.fragility._limit_states import (
    LIMIT_STATES,
    NOMINAL,
    OVERTURNED,
    OVERTURNING,
    ROCKED,
    ROCKING,
    TENDON_YIELD,
    UPLIFT,
    LimitState,
    bounded_demand,
    check_limit_columns,
    demand_limit_state,
    limit_state_label,
    limit_state_of,
    nominal_rotation_symbol,
    observed_exceedance_fractions,
    residual_rotation_limit_state,
    rocked_runs,
    rotation_limit_state,
)
from rockflex.fragility._logistic import LogisticFit, UnanimousOutcome, fit_logistic
from rockflex.fragility._lognormal import LognormalFragility, fit_capacities, fit_stripes
from rockflex.fragility._outcomes import OutcomeFragility, OutcomeProbabilities, RotationFragility, fit_outcomes

__all__ = [
    "LIMIT_STATES",
    "NOMINAL",
    "OVERTURNED",
    "OVERTURNING",
    "ROCKED",
    "ROCKING",
    "TENDON_YIELD",
    "UPLIFT",
    "AnnualRate",
    "BootstrapBand",
    "CloudFit",
    "CloudFits",
    "HazardCurve",
    "LimitState",
    "LogisticFit",
    "LognormalFragility",
    "OutcomeFragility",
    "OutcomeProbabilities",
    "RotationFragility",
    "UnanimousOutcome",
    "annual_rate",
    "bootstrap_band",
    "bootstrap_weights",
    "bounded_demand",
    "check_limit_columns",
    "compare_measures",
    "demand_limit_state",
    "fit_capacities",
    "fit_cloud",
    "fit_clouds",
    "fit_each_cloud",
    "fit_logistic",
    "fit_outcomes",
    "fit_stripes",
    "hazard_quadrature",
    "limit_state_label",
    "limit_state_of",
    "measure_damping_of_runs",
    "nominal_rotation_symbol",
    "observed_exceedance_fractions",
    "recordings_of_runs",
    "resampled_exceedance",
    "residual_rotation_limit_state",
    "risk_targeted_median",
    "rocked_runs",
    "rotation_limit_state",
    "write_nrml",
    "write_pelicun",
]
