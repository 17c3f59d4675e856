"""The main numbers of a run, and the paper's tables."""

import dataclasses
from typing import Iterable, List, Optional

import numpy

from train_brake_report import paper
from train_brake_report.figure import Figure, Table, minus
from train_brake_report.run import MODEL_NAMES, Run


@dataclasses.dataclass
class Fact:
    key: str  # where it stands in summary.json
    name: str
    value: object  # as it stands there
    text: str
    more: str = ""


@dataclasses.dataclass
class Card:
    """The data of a run that the page needs after the run is released from memory."""

    label: str
    name: str
    title: str
    given: str
    complete: Optional[bool]
    notes: List[str]
    facts: List[Fact]
    config_text: str  # these four are empty if unknown
    config_file: str
    digest: str
    version: str  # of the program that ran


def _extreme(facts: List[Fact], run: Run, key: str, name: str, sign: int) -> None:
    if run.summary is not None:
        extreme = run.summary[key]
        if extreme is not None:
            facts.append(
                Fact(
                    f"{key}.value",
                    name,
                    extreme["value"],
                    minus(f"{1e-3 * extreme['value']:.1f} kN"),
                    f"coupler {extreme['connection']}, {extreme['time_s']:.2f} s",
                )
            )
    elif run.recording.forces is not None and run.vehicles > 1:
        forces = sign * run.recording.forces["coupler_force_n"]
        record, connection = numpy.unravel_index(forces.argmax(), forces.shape)
        value = float(sign * forces[record, connection])
        facts.append(
            Fact(
                f"{key}.value",
                name,
                value,
                minus(f"{1e-3 * value:.1f} kN"),
                f"coupler {connection + 1}, {run.recording.forces.time_s[record]:.2f} s; of the "
                + ("records" if run.has_all_records else "recorded part"),
            )
        )


def facts_of(run: Run) -> List[Fact]:
    """From summary.json; from the bag as far as it goes where there is none."""
    summary, facts = run.summary or {}, []
    facts.append(Fact("vehicles", "vehicles", run.vehicles, f"{run.vehicles}"))
    simulated_s = summary.get("simulated_s", run.end_s)
    facts.append(Fact("simulated_s", "simulated", simulated_s, f"{simulated_s:g} s"))
    if run.recording.state is not None or summary:
        final = summary.get("final_speed_kmh", {}).get("mean")
        final = float(run.mean_speed_kmh[-1]) if final is None else final
        facts.append(Fact("final_speed_kmh.mean", "speed at the end", final, minus(f"{final:.3f} km/h")))
    if summary.get("stopped"):
        facts.append(
            Fact(
                "stop_time_s",
                "stopped after",
                summary["stop_time_s"],
                f"{summary['stop_time_s']:.2f} s",
                f"{summary['stop_distance_m']:.1f} m",
            )
        )
    elif run.recording.state is not None:
        state = run.recording.state
        way_m = float((state["position_m"][-1] - state["position_m"][0]).mean())
        facts.append(
            Fact("", "distance", way_m, f"{way_m:.0f} m", "" if run.has_all_records else "of the recorded part")
        )
    _extreme(facts, run, "max_tension_n", "largest tension", 1)
    _extreme(facts, run, "max_compression_n", "largest compression", -1)
    twin = summary.get("twin")
    if twin:
        spread = max(twin["max_tension_spread_n"], twin["max_compression_spread_n"])
        facts.append(
            Fact(
                "twin",
                "maxima determined to",
                spread,
                f"{1e-3 * spread:.3g} kN",
                f"by a twin whose start differs by {twin['start_offset_kmh']:g} km/h",
            )
        )
    slides = summary.get("slides")
    if slides and slides["slides"]:
        locked = sum(w["locked_s"] > 0 for w in slides["wheelsets"])
        facts.append(
            Fact(
                "slides.slides",
                "slides of wheelsets",
                slides["slides"],
                f"{slides['slides']}",
                f"{len(slides['wheelsets'])} wheelset(s), {locked} locked, {slides['flat_risks']} with risk of a flat",
            )
        )
    if "energy" in summary and summary["energy"]["initial_j"] > 0.0:
        share = summary["energy"]["residual_j"] / summary["energy"]["initial_j"]
        facts.append(
            Fact(
                "energy.residual_j",
                "energy residual",
                summary["energy"]["residual_j"],
                minus(f"{share:+.1e}"),
                "of the initial energy",
            )
        )
    if "real_time_factor" in summary:
        facts.append(
            Fact(
                "real_time_factor",
                "times real time",
                summary["real_time_factor"],
                f"{summary['real_time_factor']:.1f}",
                f"{summary['wall_s']:.1f} s of wall time",
            )
        )
    return facts


def card_of(run: Run) -> Card:
    name = f"{run.scenario or run.bag.name}, {MODEL_NAMES.get(run.model, run.model)}"
    return Card(
        run.label,
        name,
        (run.config or {}).get("description", ""),
        str(run.given),
        run.complete,
        run.notes,
        facts_of(run),
        run.config_text,
        str(run.config_file or ""),
        run.digest or "",
        (run.summary or {}).get("version", ""),
    )


@dataclasses.dataclass
class PaperRow:
    """A run of the paper: what its tables compare."""

    scenario: str
    model: str
    speed_kmh: float
    wall_s: Optional[float]
    simulated_s: float


def paper_row(run: Run) -> Optional[PaperRow]:
    if not run.is_of_paper or run.recording.state is None:
        return None
    return PaperRow(
        run.scenario, run.model, float(run.mean_speed_kmh[-1]), (run.summary or {}).get("wall_s"), run.end_s
    )


def calibrated(models: Iterable[str]) -> str:
    """A sentence comparing the values of these models with the paper's."""
    if "ltd-no-inertia" not in models:
        return "The values here are predictions (docs/validation.md)."
    return "LTD without rotational inertia was calibrated on them; other models are predictions (docs/validation.md)."


def table_1(rows: List[PaperRow]) -> Figure:
    texts = []
    for row in sorted(rows, key=lambda r: (paper.MODELS.index(r.model), paper.SCENARIOS.index(r.scenario))):
        printed = paper.SPEED_KMH[row.model, row.scenario]
        texts.append(
            [
                MODEL_NAMES[row.model],
                row.scenario,
                f"{printed:.2f}",
                f"{row.speed_kmh:.3f}",
                minus(f"{row.speed_kmh - printed:+.3f}"),
                "calibrated" if row.model == "ltd-no-inertia" else "predicted",
            ]
        )
    return Figure(
        "table_1",
        "Table 1: speed at the last step",
        "Mean speed of the train's momentum, beside the paper's values. " + calibrated({row.model for row in rows}),
        table=Table(["model", "scenario", "paper [km/h]", "here [km/h]", "difference [km/h]", ""], texts),
    )


def table_2(rows: List[PaperRow]) -> Figure:
    texts = []
    for row in sorted(rows, key=lambda r: (paper.SCENARIOS.index(r.scenario), -paper.MODELS.index(r.model))):
        if row.wall_s is None:
            continue
        two_d = row.model == "2d"
        wall_s, cpu_s = paper.WALL_S[row.scenario], paper.CPU_S[row.scenario]
        texts.append(
            [
                row.scenario,
                MODEL_NAMES[row.model],
                f"{row.simulated_s:g}",
                f"{wall_s}" if two_d else "",
                f"{cpu_s}" if two_d else "",
                f"{row.simulated_s / wall_s:.2f}" if two_d else "",
                f"{row.wall_s:.1f}",
                f"{row.simulated_s / row.wall_s:.1f}",
            ]
        )
    return Figure(
        "table_2",
        "Table 2: computing time",
        "The paper's times are those of its 2D train on 243 cores. Those here include the recording of the bag, and "
        "depend on the "
        "number of threads and wagon nodes and on what else the machine did.",
        table=Table(
            [
                "scenario",
                "model",
                "simulated [s]",
                "paper, wall [s]",
                "paper, CPU [s]",
                "paper, times real time",
                "here, wall [s]",
                "here, times real time",
            ],
            texts,
        ),
    )
