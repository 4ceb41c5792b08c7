"""Multiple-stripe analysis: every record scaled to each of a few intensities."""

from rockflex.study.stripes._study import StripePlan, StripeStudy, stripe_counts

__all__ = ["StripePlan", "StripeStudy", "stripe_counts"]
