"""What the paper prints: Wu, Cole & Spiryagin, Vehicle System Dynamics 58(8), 2020."""

SCENARIOS = ["emergency", "full_service", "minimum"]
MODELS = ["ltd-no-inertia", "ltd", "2d"]
VEHICLES = 242
DURATION_S = {"emergency": 70.0, "full_service": 90.0, "minimum": 150.0}

# Table 1: speed at the last step [km/h].
SPEED_KMH = {
    ("ltd-no-inertia", "emergency"): 3.97, ("ltd-no-inertia", "full_service"): 1.05, ("ltd-no-inertia", "minimum"): 77.29,
    ("ltd", "emergency"): 9.86, ("ltd", "full_service"): 7.20, ("ltd", "minimum"): 77.45,
    ("2d", "emergency"): 9.94, ("2d", "full_service"): 7.18, ("2d", "minimum"): 77.42,
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


def is_of_paper(run) -> bool:
    """By scenario, train length and duration. That no other value was changed is not known."""
    return (run.scenario in SCENARIOS and run.model in MODELS and run.vehicles == VEHICLES
            and run.complete is not False and abs(run.end_s - DURATION_S[run.scenario]) < 0.02)
