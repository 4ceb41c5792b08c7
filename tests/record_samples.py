"""Files in the formats of strong-motion networks, written from the published descriptions, with synthetic samples."""

import warnings
from collections.abc import Sequence

import numpy as np
import pytest

COUNTS = [8000, 8120, 7760, 8240, 8010, 7950, 7999, 8001, 8003, 7917]  # mean 8000
GAL = 3920 / 6182761
SAMPLES = [0.0, 1.25, -3.5, 12.125, -8.0, 0.5, 0.25, 0.0]  # cm/s²


def load_obspy():
    """ObsPy, whose import warns of the age of what it uses; without it the test is skipped."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return pytest.importorskip("obspy")


def knet(
    direction: str = "N-S",
    counts: Sequence[int] = COUNTS,
    *,
    peak: float | None = None,
    scale: str = "3920(gal)/6182761",
    station: str = "MYG002",
    rate: int = 10,
    duration: float | None = None,
    maximum: str = "Max. Acc. (gal)",
) -> str:
    """A K-NET or KiK-net file; the peak is that of the samples without their mean."""
    numerator, denominator = scale.replace("(gal)", "").split("/")
    if peak is None:
        samples = np.array(counts, dtype=float) * float(numerator) / float(denominator)
        peak = float(np.max(np.abs(samples - samples.mean())))
    header = {
        "Origin Time": "2006/01/18 23:25:00",
        "Lat.": "37.798",
        "Long.": "142.200",
        "Depth. (km)": "36",
        "Mag.": "5.7",
        "Station Code": station,
        "Station Lat.": "38.7262",
        "Station Long.": "141.5109",
        "Station Height(m)": "79",
        "Record Time": "2006/01/18 23:25:46",
        "Sampling Freq(Hz)": f"{rate}Hz",
        "Duration Time(s)": f"{len(counts) / rate if duration is None else duration:g}",
        "Dir.": direction,
        "Scale Factor": scale,
        maximum: f"{peak:.3f}",
        "Last Correction": "2006/01/18 23:25:31",
        "Memo.": "",
    }
    rows = ["".join(f"{value:9d}" for value in counts[k : k + 8]) for k in range(0, len(counts), 8)]
    return "\n".join([*(f"{name:<18}{value}" for name, value in header.items()), *rows]) + "\n"


def esm(samples: Sequence[float] = SAMPLES, stream: str = "HNE", **changed: str) -> str:
    """An ESM file (DYNA 1.2); keys are changed by name, with _ for characters that are none in names."""
    header = {
        "EVENT_NAME": "CENTRAL_ITALY",
        "EVENT_ID": "EMSC-20161030_0000029",
        "EVENT_DATE_YYYYMMDD": "20161030",
        "EVENT_TIME_HHMMSS": "064018",
        "EVENT_LATITUDE_DEGREE": "42.8322",
        "EVENT_LONGITUDE_DEGREE": "13.1107",
        "EVENT_DEPTH_KM": "9.2",
        "MAGNITUDE_W": "6.5",
        "MAGNITUDE_W_REFERENCE": "Bulletin",
        "MAGNITUDE_L": "6.1",
        "FOCAL_MECHANISM": "Normal faulting",
        "NETWORK": "IT",
        "STATION_CODE": "NRC",
        "STATION_NAME": "NORCIA",
        "LOCATION": "00",
        "VS30_M/S": "498",
        "EPICENTRAL_DISTANCE_KM": "4.6",
        "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS": "20161030_064013.250",
        "SAMPLING_INTERVAL_S": "0.005000",
        "NDATA": str(len(samples)),
        "DURATION_S": f"{0.005 * len(samples):.3f}",
        "STREAM": stream,
        "UNITS": "cm/s^2",
        "INSTRUMENT_ANALOG/DIGITAL": "D",
        "PGA_CM/S^2": f"{max(samples, key=abs):.6f}",
        "TIME_PGA_S": "0.015",
        "LATE/NORMAL_TRIGGERED": "NT",
        "HEADER_FORMAT": "DYNA 1.2",
        "DATA_TYPE": "ACCELERATION",
        "USER5": "",
    }
    plain = {key.replace("/", "_").replace("^", "_"): key for key in header}
    header |= {plain[key]: value for key, value in changed.items()}
    return (
        "\n".join([*(f"{key}: {value}" for key, value in header.items()), *(f"{each:.6f}" for each in samples)]) + "\n"
    )


def cosmos(
    code: int = 90,
    samples: Sequence[float] = SAMPLES,
    *,
    channel: int = 1,
    integers: dict[int, int] | None = None,
    reals: dict[int, float] | None = None,
    kind: str = "acceleration",
    units: str = "cm/sec2(04)",
    form: tuple[int, str] = (8, "F10.3"),
    first: str = "Corrected acceleration",
) -> str:
    """A channel of a COSMOS file (version 1.20); header values are changed by their places, which count from 1."""
    whole = dict.fromkeys(range(1, 101), -999)
    whole |= {1: 2, 2: 1, 3: 4, 40: 2014, 42: 1, 43: 15, 44: 9, 45: 35, 50: channel, 54: code} | (integers or {})
    real = dict.fromkeys(range(1, 101), -999.0)
    peak = max(samples, key=abs)
    real |= {4: 0.36, 13: 4.4, 17: 21.5, 30: 12.25, 62: 5.0, 63: 0.005 * len(samples), 64: peak, 65: 0.015}
    real |= reals or {}
    text = [
        f"{first:<26}(Format v01.20 with 13 text lines) Src: made up",
        "Rcrd of Fontana               Earthquake of Wed Jan 15, 2014 01:35 PST",
        "Hypocenter: 34.143   -117.443   H=  3km       ML=     Mw=4.4",
        "Origin: 01/15/2014, 09:35:19.0 UTC",
        "Statn No: 05- 13921 Code:CE-13921  CGS  Riverside - Limonite & Downey",
        "Coords: 33.975  -117.487   Site geology:",
        "Recorder: Etna   s/n 1614 ( 3 Chns of   3 at Sta) Sensor: FBA",
        "Rcrd start time: 1/15/2014, 09:35:12.250 UTC (Q=5) RcrdId: 13921-L1614",
        f"Sta Chan  {channel}: {code} deg (Rcrdr Chan  {channel})",
        "Raw record length =  56.000 sec, Uncor max =    20108 counts, at   25.205 sec.",
        f"Processed: 01/15/14                      Max = {peak:9.3f} cm/s^2   at   0.015 sec",
        "Record filtered below  0.30 Hz (periods over   3.3 secs)  and above 40.0 Hz",
        "Values used when parameter or data value is unknown/unspecified:   -999, -999.0",
    ]
    columns, number = form

    def block(values: Sequence[float], n: int, spec: str) -> list[str]:
        kind, digits = spec[0], spec[1:]
        written = [f"{int(v):{digits}d}" if kind == "I" else f"{v:{digits}{kind.lower()}}" for v in values]
        return ["".join(written[k : k + n]) for k in range(0, len(written), n)]

    return "\n".join(
        [
            *text,
            " 100 Integer-header values follow on  10 lines, Format= (10I8)",
            *block(list(whole.values()), 10, "I8"),
            " 100 Real-header values follow on  20 lines, Format= (5F15.6)",
            *block(list(real.values()), 5, "F15.6"),
            '   2 Comment line(s) follow, each starting with a "|":',
            "| Sensor: FBA",
            "| 4 acceleration pts, in a comment, Format=(1F10.3)",
            f"{len(samples):8d} {kind} pts, approx    0 secs, units={units},Format=({columns}{number})",
            *block(samples, columns, number),
            f"End-of-data for Chan  {channel} {kind}",
            "",
        ]
    )


def geonet(
    component: str = "N76E",
    samples: Sequence[float] = SAMPLES,
    *,
    corrected: bool = True,
    integers: dict[int, int] | None = None,
    reals: dict[int, float] | None = None,
    digits: int = 3,
) -> str:
    """A component of a GeoNet file, in mm/s²; header values are changed by their places, which count from 1."""
    whole = dict.fromkeys(range(1, 41), 0)
    whole |= {1: 2019, 2: 3, 3: 5, 4: 7, 5: 9, 6: 112, 9: 2019, 10: 3, 19: 5, 20: 7, 39: 8, 40: 59125, 28: 76, 30: 21}
    n_more = len(samples) if corrected else 0
    whole |= {31: len(samples), 34: len(samples), 35: n_more, 36: n_more} | (integers or {})
    real = dict.fromkeys(range(1, 61), 0.0)
    peak = max(samples, key=abs)
    real |= {8: 1.0, 15: 5.4, 25: 0.005, 26: 0.005, 30: 9806.6, 36 if corrected else 31: peak} | (reals or {})
    text = [
        f"{'Corrected' if corrected else 'Uncorrected'} accelerogram 20190305_070859_MADE_20 GNS Science",
        "Site MADE      41 10 20S  174 30 40E     Made for tests",
        "A Made-up Place",
        "Instrument None",
        "Resolution: 24-bit   Instr Period: 0.0050 s   Damping: 0.700",
        "Accelerogram 20190305_070859_MADE_20",
        "20 km from A MADE-UP TOWN",
        "2019 March 5             07:09:11 UT",
        "Epicentre  41 20 20S 174 40 40E",
        f"Number of points  {len(samples):5d}",
        "Raw readings in units of 1.00 mm/s/s  at intervals of 0.005 s",
        "Data is made up",
        f"Component {component}",
        f"Acceleration:  Peak {peak:9.1f} mm/s/s",
        "Velocity:",
        "Displacement:",
    ]

    def block(written: Sequence[str]) -> list[str]:
        return ["".join(written[k : k + 10]) for k in range(0, len(written), 10)]

    rows = [
        *block([f"{value:8d}" for value in whole.values()]),
        *block([f"{value:8.5g}" for value in real.values()]),
        *block([f"{value:8.{digits}f}" for value in samples]),
        *block([f"{0.5:8.1f}"] * n_more) * 2,
    ]
    return "\n".join([*text, *rows]) + "\n"


def csmip(
    component: str = "90 DEG",
    samples: Sequence[float] = SAMPLES,
    *,
    volume: int = 2,
    data_line: str = "{n} POINTS OF ACCEL DATA EQUALLY SPACED AT  .005 SEC.  (UNITS: CM/SEC/SEC)",
    text_unit: str = "IS G",
    peak: str | None = None,
    width: int = 10,
    digits: int = 3,
    times: Sequence[float] | None = None,
) -> str:
    """A channel of a CSMIP file, of V1 or V2; with times, pairs of time and acceleration of an old V1."""
    n = len(samples)
    v1 = [
        "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 06/16/98, CDMG 23583",
        "SOMEWHERE EARTHQUAKE",
        "JUNE 28, 1992 08:05 PDT                 (ORIGIN(USGS): 06/28/92, 15:05:30.5 UTC)",
        "23583-E0245-92183.06               TRIGGER TIME: 06/28/92, 15:05:37.4 UTC",
        "STATION NO. 23583   34.405N, 117.311W     SSA-1  S/N 0245",
        "SOME PLACE - 4TH STREET",
        f"CHAN  1: {component}",
        "SOMEWHERE EARTHQUAKE     JUNE 28, 1992 08:05 PDT",
        "HYPOCENTER(CIT/USGS): 34.201N,116.826W, H=7KM.     MS=6.6(NEIC), MW=6.4(CIT)",
        "INSTR PERIOD =  .0186 SEC,  DAMPING =  .660,  SENSITIVITY = 1.26  V/G.",
        f"NO. OF POINTS =  {n}  RECORD LENGTH = {0.005 * (n - 1):.3f} SEC",
        f"UNITS OF UNCOR ACCEL {text_unit}.                 MAX  =  {peak or '9.9 VOLT'}, AT   9.425 SEC.",
        "RMS ACCEL OF COMPLETE RECORD =  .008 G.",
    ]
    v2 = [
        f"CORRECTED ACCELEROGRAM   23583-E0245-92183.06       CHAN  1: {component}     FROM",
        *v1[:5],
        *(
            "SOME PLACE - 4TH STREET",
            f"CHAN  1: {component}",
            "SOMEWHERE EARTHQUAKE     JUNE 28, 1992 08:05 PDT",
            v1[8],
        ),
        *(v1[9], "RECORD LENGTH = 65.000 SEC.", "                    UNCOR MAX  =  -.275 G, AT  10.947 SEC.", v1[12]),
        "ACCELEROGRAM BANDPASS FILTERED WITH RAMPS AT  .050- .100 AND 23.00-25.00 CYC/SEC",
        f"  {n} POINTS OF INSTRUMENT- AND BASELINE-CORRECTED ACCEL, VELOC AND DISPL DATA",
        "AT EQUALLY-SPACED INTERVALS OF    .005  SEC.",
        f"PEAK ACCELERATION =  {peak or f'{max(samples, key=abs):.3f}    CM/SEC/SEC'}  AT   10.940   SEC.",
        *["PEAK   VELOCITY   =   -28.253      CM/SEC    AT   11.100   SEC."] * 7,
    ]

    def block(values: Sequence[float], n: int, width: int, digits: int) -> list[str]:
        written = [f"{value:{width}.{digits}f}" for value in values]
        return ["".join(written[k : k + n]) for k in range(0, len(written), n)]

    head = [*(v2 if volume == 2 else v1), *block([0.0] * 100, 16, 5, 0), *block([0.0] * 50 * volume, 8, 10, 3)]
    if times is not None:
        pairs = [value for pair in zip(times, samples, strict=True) for value in pair]
        return "\n".join([*head, *block(pairs, 10, 7, 3), "/&  ----------  END OF DATA FOR CHANNEL  1", ""])
    rows = [data_line.format(n=n), *block(samples, 8, width, digits)]
    if volume == 2:
        for other in ("VELOC", "DISPL"):
            rows += [f"{n} POINTS OF {other} DATA EQUALLY SPACED AT  .005 SEC.", *block([1.0] * n, 8, 10, 3)]
    return "\n".join([*head, *rows, "/&  ----------  END OF DATA FOR CHANNEL  1  ----------", ""])


def smc(
    samples: Sequence[float] = SAMPLES,
    *,
    first: str = "2 CORRECTED ACCELEROGRAM",
    component: str = "360",
    integers: dict[int, int] | None = None,
    reals: dict[int, float] | None = None,
) -> str:
    """An SMC file; header values are changed by their places, which count from 1."""
    whole = dict.fromkeys(range(1, 49), -32768)
    whole |= {2: 1989, 13: 90, 14: 360, 16: 2, 17: len(samples)} | (integers or {})
    real = dict.fromkeys(range(1, 51), 1.7e38)
    real |= {2: 200.0, 6: 7.1, 17: 89.0, 30: max(samples), 32: min(samples)} | (reals or {})
    text = [
        first,
        "*",
        "SAF0A",
        "     1989  10  18    0004 Loma Prieta, CA",
        "Moment Mag=      7.1 Ms=      7.1 Ml=      7.0",
        f"station = San Francisco, F component=    {component}",
        "epicentral dist =     89.0       pk     =    104.4",
        "inst type=SMA-1      data source = USGS",
        *["*"] * 3,
    ]

    def block(written: Sequence[str], n: int) -> list[str]:
        return ["".join(written[k : k + n]) for k in range(0, len(written), n)]

    def short(value: float) -> str:  # one digit of the exponent
        number, power = f"{value:.4E}".split("E")
        return f"{number}E{int(power):+d}".rjust(10)

    rows = [
        *block([f"{value:10d}" for value in whole.values()], 8),
        *block([f"{value:15.7E}" for value in real.values()], 5),
        *("|", "|A comment"),
        *block([short(value) for value in samples], 8),
    ]
    return "\n".join([*text, *rows, ""])


SEARCH_RESULTS = """
 PEER Ground Motion Database, Time Series Search Report -- NGA-West2 -- 2025-12-30


 -- Summary of PEER Ground Motion Database Search Criteria --
Magnitude Min:, 0.0
Record Sequence Number:,
Earthquake Name:,
Station Name:,


 -- Summary of Metadata of Selected Records --
Result ID, Spectral Ordinate, Record Sequence Number, Mean Squared Error, Scale Factor, Tp-Pulse Period (sec), \
5-75% Duration (sec), 5-95% Duration (sec), Arias Intensity (m/sec), Earthquake Name, Year, Station Name, Magnitude, \
Mechanism, Rjb (km), Rrup (km), Vs30 (m/sec), Lowest Useable Frequency (Hz), Initial-search Scale Factor, \
Horizontal-1 Acc. Filename, Horizontal-2 Acc. Filename, Vertical Acc. Filename
1, SRSS, 9001, 0.4768, 1.0, -, 17.7, 24.2, 1.6, "Somewhere_ Italy-02", 1940, "Array #9_ East", 6.95, strike slip, \
6.09, 7.5, 213.44, 0.25, 1.0, RSN9001_SOME_ABC180.AT2, RSN9001_SOME_ABC270.AT2 , RSN9001_SOME_ABC-UP.AT2
2, SRSS, 9002, 2.6332, 1.0, 1.463, 12.4, 33.6, 0.3, "Elsewhere", 1952, "Courthouse", 7.36, Reverse, \
81.3, 82.19, -999, 0.375, 1.0, RSN9002_ELSE_DEF042.AT2, RSN9002_ELSE_DEF132.AT2 ,  -----

 These records were obtained from the NGA-West2 On-Line Ground-Motion Database Tool
 These records are UNSCALED, AS RECORDED

 -- Scaled Spectra used in Search & Scaling --
Period (sec),Target pSa (g),Arithmetic Mean pSa (g),RSN-9001 SRSS pSa (g)
0.01,0.53,0.31,0.35
"""


def at2(
    component: str,
    peak: float = 0.1,
    station: str = "Some Station",
    *,
    samples: Sequence[float] | None = None,
    event: str = "Some Event",
    dt: float = 0.1,
) -> str:
    """An AT2 file, of three samples with a peak if no others are given."""
    values = [0.0, peak, 0.0] if samples is None else samples
    head = f"{event}, 1/1/2001, {station}, {component}\nACCELERATION IN UNITS OF G\nNPTS= {len(values)}, DT= {dt:g}\n"
    return head + "".join(f"{value: .7E}\n" for value in values)
