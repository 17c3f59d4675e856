"""What the paper prints: Wu, Cole & Spiryagin, Vehicle System Dynamics 58(8), 2020."""

import functools
import pathlib
import subprocess
import tempfile
from typing import Sequence, Tuple

import yaml

SCENARIOS = ["emergency", "full_service", "minimum"]
MODELS = ["ltd-no-inertia", "ltd", "2d"]
VEHICLES = 242
DURATION_S = {"emergency": 70.0, "full_service": 90.0, "minimum": 150.0}

# Table 1: speed at the last step [km/h].
SPEED_KMH = {
    ("ltd-no-inertia", "emergency"): 3.97,
    ("ltd-no-inertia", "full_service"): 1.05,
    ("ltd-no-inertia", "minimum"): 77.29,
    ("ltd", "emergency"): 9.86,
    ("ltd", "full_service"): 7.20,
    ("ltd", "minimum"): 77.45,
    ("2d", "emergency"): 9.94,
    ("2d", "full_service"): 7.18,
    ("2d", "minimum"): 77.42,
}

# Table 2: the 2D train on 243 cores: wall time [s], CPU time of all cores [s].
WALL_S = {"emergency": 4 * 60 + 32, "full_service": 6 * 60 + 4, "minimum": 11 * 60 + 59}
CPU_S = {"emergency": 3600 + 11 * 60 + 24, "full_service": 48 * 60 + 12, "minimum": 3600 + 35 * 60 + 23}

# Figure 11 and its text: largest tension of coupler 105 in the emergency run, near 35 s [kN].
COUPLER = 105
COUPLER_TENSION_KN = {"ltd": 750.0, "2d": 484.0}
COUPLER_TIME_S = 35.0

# Figure 10a: where the paper's 2D train has tensions lower by more than 200 kN (first and last coupler).
LOWER_COUPLERS = (99, 116)
LARGEST_DIFFERENCE_KN = 266.0

WAGON = 100  # Figure 9


HERE = pathlib.Path(__file__).resolve().parent
# In the source tree, in an install space.
CONFIG = next(
    (
        folder
        for folder in (HERE.parents[1] / "config", HERE.parents[3] / "share" / "train_brake" / "config")
        if folder.is_dir()
    ),
    HERE,
)
# What a run of the paper may have otherwise; its duration is judged by its last record.
FREE = {"name", "description", "model", "duration_s", "record_interval_s", "ledger_interval_s", "detail_vehicles"}


@functools.lru_cache(maxsize=None)
def _configuration(scenario: str, train_sim: Tuple[str, ...]) -> dict:
    """Of a scenario of the paper, with all its parts, as train_sim writes it. Raises OSError, CalledProcessError."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(
            [
                *train_sim,
                "run",
                str(CONFIG / "scenarios" / f"{scenario}.yaml"),
                "--out",
                folder,
                "--model",
                "ltd",
                "--set",
                "duration_s=0.01",
            ],
            check=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        return yaml.safe_load((pathlib.Path(folder) / "config.yaml").read_text(encoding="utf-8"))


def difference(value, papers, where: str = "") -> str:
    """Where two configurations first differ; empty if nowhere."""
    if isinstance(value, dict) and isinstance(papers, dict):
        parts = [(f"{where}.{key}" if where else key, value.get(key), papers.get(key)) for key in {**papers, **value}]
    elif isinstance(value, list) and isinstance(papers, list) and len(value) == len(papers):
        parts = [(f"{where}[{i}]", *pair) for i, pair in enumerate(zip(value, papers))]
    elif value == papers:
        return ""
    elif any(isinstance(v, (dict, list)) for v in (value, papers)):
        return f"{where} is another"
    else:
        return f"{where} is {value}, there {papers}"
    return next(filter(None, (difference(a, b, name) for name, a, b in parts)), "")


def judge(run, train_sim: Sequence[str]) -> None:
    """Whether the run is one of the paper's; if only its name is, a note says why it is not."""
    if not (
        run.scenario in SCENARIOS
        and run.model in MODELS
        and run.vehicles == VEHICLES
        and run.complete is not False
        and abs(run.end_s - DURATION_S[run.scenario]) < 0.02
    ):
        return
    try:
        reason = (
            "its configuration is not known"
            if run.config is None
            else difference(
                *(
                    {key: value for key, value in config.items() if key not in FREE}
                    for config in (run.config, _configuration(run.scenario, tuple(train_sim)))
                )
            )
        )
    except (OSError, subprocess.CalledProcessError):
        reason = "train_sim, which knows the paper's configuration, cannot be run"
    run.is_of_paper = not reason
    if reason:
        run.notes.append(f"Not compared with the paper's {run.scenario}: {reason}.")
