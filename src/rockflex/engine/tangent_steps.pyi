from rockflex.foundation.arrays import Array

class Motion:
    def __init__(
        self,
        rates: Array,
        rows: Array,
        rates_v: Array,
        rows_v: Array,
        d_rates: Array,
        d_rows: Array,
        d_rates_v: Array,
        d_rows_v: Array,
        scales: Array,
        tables: Array,
        slopes: Array,
        whole: int,
        h: float,
        speed: float,
    ) -> None: ...
