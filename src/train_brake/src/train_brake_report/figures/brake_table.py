"""Cylinder pressure and wave speed over the reduction of the brake pipe (the paper's Figure 1), of the run's own
brake."""

import numpy

from train_brake_report import style
from train_brake_report.figure import Figure, new_canvas
from train_brake_report.group import Group
from train_brake_report.run import Run


def _why_not(run: Run) -> str:
    if not run.config:
        return "the configuration is not known"
    if run.config.get("pressure_table"):
        return "the pressures come from a table"
    return "" if "service" in (run.config.get("brake") or {}) else "its brake has no table of reductions"


def draw(group: Group) -> Figure:
    runs, not_shown = group.drawable(_why_not)
    brake = runs[0].config["brake"]
    service, emergency = brake["service"], brake["emergency"]
    reduction = numpy.array(service["reduction_kpa"])
    canvas = new_canvas(5.4)
    above, below = canvas.subplots(2, 1, sharex=True)
    above.plot(reduction, service["cylinder_pressure_kpa"], "o-", color=style.BLUE, label="service")
    above.axhline(emergency["cylinder_pressure_kpa"], color=style.VERMILLION, linestyle=(0, (4, 3)), label="emergency")
    line = numpy.linspace(0.0, emergency["cylinder_pressure_kpa"] / 2.5, 50)
    above.plot(line, 2.5 * line, color=style.MUTED, linewidth=1.0, label="2.5 : 1")
    above.set_ylabel("cylinder pressure [kPa]")
    below.plot(reduction, service["wave_speed_mps"], "o-", color=style.BLUE, label="service")
    below.axhline(emergency["wave_speed_mps"], color=style.VERMILLION, linestyle=(0, (4, 3)), label="emergency")
    below.set_ylabel("wave speed [m/s]")
    below.set_xlabel("total reduction of the brake pipe [kPa]")
    style.legend_above(above)
    caption = (
        f"The brake {brake.get('name', '')}: steady cylinder pressure and speed of the brake wave over the total "
        f"reduction. "
        "The paper's Figure 1 prints curves and no numbers; points were read from it, between them the model takes a "
        f"monotone cubic. The thin line is a valve of 2.5 : 1.{not_shown}"
    )
    return Figure("brake_table", "Cylinder pressure and wave speed over the reduction", caption, canvas)
