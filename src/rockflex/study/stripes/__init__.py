"""Multiple-stripe analysis: every record scaled to each of a few intensities."""

from rockflex.study.stripes._study import StripeLimit, StripePlan, StripeStudy, stripe_counts, stripe_limit

__all__ = ["StripeLimit", "StripePlan", "StripeStudy", "stripe_counts", "stripe_limit"]
