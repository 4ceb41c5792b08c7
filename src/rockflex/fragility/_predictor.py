"""The line a + b ln(IM) of every fit: its standard error, and the scaling that keeps solvers well conditioned."""

import numpy as np

from rockflex._arrays import Array


class Standardised:
    """Logarithms scaled to mean 0 and standard deviation 1, and back."""

    def __init__(self, x: Array) -> None:
        mean, spread = float(x.mean()), float(x.std())
        self._mean, self._spread = mean, spread
        self.x = self.of(x)
        self.design = np.column_stack((np.ones(x.size), self.x))
        self._back = np.array([[1.0, -mean / spread], [0.0, 1.0 / spread]])

    def of(self, x: Array) -> Array:
        """Other logarithms on the same scale."""
        return (x - self._mean) / self._spread

    def back(self, parameters: Array) -> Array:
        """Intercepts and slopes for the original logarithms, shape (m, 2)."""
        return parameters @ self._back.T

    def unscaled(self, parameters: Array, covariance: Array) -> tuple[float, float, Array]:
        """Intercept, slope and covariance for the original logarithms."""
        a, b = self._back @ parameters
        return float(a), float(b), self._back @ covariance @ self._back.T


def standard_error(x: Array, covariance: Array) -> Array:
    """Standard error of a + b x for the covariance of (a, b)."""
    variance = covariance[0, 0] + 2.0 * covariance[0, 1] * x + covariance[1, 1] * x**2
    return np.sqrt(np.maximum(variance, 0.0))  # rounding may leave a small negative variance
