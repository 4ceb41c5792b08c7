"""Fragility and risk: regressions of study results, their confidence bands, and their integrals over hazard."""

from rockflex.fragility._annual_rate import AnnualRate, annual_rate, quadrature, risk_targeted_median
from rockflex.fragility._bootstrap import BootstrapBand, bootstrap_band, resample_weights, resampled_exceedance
from rockflex.fragility._cloud import CloudFit, compare_measures, fit_cloud
from rockflex.fragility._clouds import CloudFits, fit_clouds, fit_each_cloud, recordings_of
from rockflex.fragility._exports import write_nrml, write_pelicun
from rockflex.fragility._hazard import HazardCurve, damping_of
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
    beyond,
    limit_label,
    observed_fractions,
    residual_beyond,
    rocked,
    symbol_of_nominal,
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
    "beyond",
    "bootstrap_band",
    "compare_measures",
    "damping_of",
    "fit_capacities",
    "fit_cloud",
    "fit_clouds",
    "fit_each_cloud",
    "fit_logistic",
    "fit_outcomes",
    "fit_stripes",
    "limit_label",
    "observed_fractions",
    "quadrature",
    "recordings_of",
    "resample_weights",
    "resampled_exceedance",
    "residual_beyond",
    "risk_targeted_median",
    "rocked",
    "symbol_of_nominal",
    "write_nrml",
    "write_pelicun",
]
