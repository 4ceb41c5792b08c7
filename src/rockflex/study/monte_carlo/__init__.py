"""Monte Carlo simulation: structures whose dimensions and elements are random, under a suite of records."""

from rockflex.study.monte_carlo._study import MonteCarloPlan, MonteCarloStudy

__all__ = ["MonteCarloPlan", "MonteCarloStudy"]
