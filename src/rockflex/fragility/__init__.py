"""Fragility and risk: regressions of study results, their confidence bands, and their integrals over hazard."""

from rockflex.fragility._annual_rate import AnnualRate, annual_rate, risk_targeted_median
from rockflex.fragility._bootstrap import BootstrapBand, bootstrap_band
from rockflex.fragility._cloud import CloudFit, compare_measures, fit_cloud
from rockflex.fragility._clouds import CloudFits, fit_clouds
from rockflex.fragility._distributions import DistributionComparison, compare_distributions
from rockflex.fragility._exports import write_nrml, write_pelicun
from rockflex.fragility._hazard import HazardCurve
from rockflex.fragility._hazard_branches import HazardBranches
from rockflex.fragility._limit_states import LIMIT_STATES, OVERTURNING, LimitState, residual_rotation_limit_state
from rockflex.fragility._logistic import LogisticFit, UnanimousOutcome, fit_logistic
from rockflex.fragility._lognormal import LognormalFragility, fit_capacities, fit_stripes
from rockflex.fragility._outcomes import OutcomeFragility, OutcomeProbabilities, RotationFragility, fit_outcomes
from rockflex.fragility._rate_shares import RateShares, rate_shares
from rockflex.fragility._subset import SubsetEstimate, subset_simulation
from rockflex.fragility._variance import variance_shares

__all__ = [
    "LIMIT_STATES",
    "OVERTURNING",
    "AnnualRate",
    "BootstrapBand",
    "CloudFit",
    "CloudFits",
    "DistributionComparison",
    "HazardBranches",
    "HazardCurve",
    "LimitState",
    "LogisticFit",
    "LognormalFragility",
    "OutcomeFragility",
    "OutcomeProbabilities",
    "RateShares",
    "RotationFragility",
    "SubsetEstimate",
    "UnanimousOutcome",
    "annual_rate",
    "bootstrap_band",
    "compare_distributions",
    "compare_measures",
    "fit_capacities",
    "fit_cloud",
    "fit_clouds",
    "fit_logistic",
    "fit_outcomes",
    "fit_stripes",
    "rate_shares",
    "residual_rotation_limit_state",
    "risk_targeted_median",
    "subset_simulation",
    "variance_shares",
    "write_nrml",
    "write_pelicun",
]
