cpdef double value(double[::1] q, int terms, double t) noexcept nogil
cpdef double unit_for(double size) noexcept nogil
cpdef double first_fall(double[::1] q, int shift, int terms, double start, double stop) noexcept nogil
cpdef (double, double) highest_of(double[::1] q, double[::1] slope, int terms, double stop, bint one_sided) noexcept nogil
