"""Cloud analysis: every structure under every record, with every model, at a few scales (Section 3.2)."""

from rockflex.study.cloud._study import CloudPlan, CloudStudy, run_cloud

__all__ = ["CloudPlan", "CloudStudy", "run_cloud"]
