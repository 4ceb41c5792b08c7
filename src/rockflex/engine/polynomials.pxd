cpdef double value(double[::1] q, int terms, double t) noexcept
cpdef double first_fall(double[::1] q, int shift, int terms, double start, double stop) noexcept
