"""`rosrun train_brake vehicle_test`: tests a node that moves external vehicles, with the calls of a train's master."""

import contextlib
import json
import math
import os
import random
import signal
import statistics
import subprocess
import sys
import time

USAGE = """usage: rosrun train_brake vehicle_test SCENARIO [NODE] [ns:=/train] [deadline_s:=1] [seconds:=10]

Tests the node that moves the external vehicles of a scenario's train; it must be running. NODE selects one of several.
It is called as by the train's master, on a level track:

  protocol       it starts with the declared speed, refuses another version, and exchanges that are not the next one
  refusal        it refuses loads that are not finite, and continues unaffected
  repeat         the last exchange is answered again, and nothing moves
  repeatability  the same loads give the same bits
  finite         every reply is
  velocity       it is the derivative of the displacement: |x1 - x0 - H (v0 + v1) / 2| <= H q + 1e-9 m,
                 q the bound of |v1 - v0| in nine of ten exchanges
  passivity      its visible kinetic energy grows by no more than the couplers' work
  mass           a step of 1 kN accelerates it as a mass of 0.2 to 1.5 times the declared one
  stability      the exchange interval H is stable with the train's connections and that mass
  slow           every reply comes within deadline_s

The built-in ltd model of the same vehicles gets the same loads; the largest differences are printed, without a verdict.
Exit codes: 0 all passed, 1 some failed, 2 bad arguments or no vehicle node to test."""

EPSILON_M = 1e-9
PASSIVE = 1e-6  # of the energy that was there and the work that went in
PULL_N = 1e3


class Failure(Exception):
    """A test that cannot continue."""


class Vehicles:
    """The vehicles of one node, called as by a train's master."""

    def __init__(self, node, scenario, told, dt_s, steps, deadline_s):
        import rospy
        from train_brake_msgs.srv import Configure, ConfigureRequest, Step, StepRequest

        self.node, self.scenario, self.told = node, scenario, told
        self.count, self.dt_s, self.steps, self.deadline_s = told["vehicles"], dt_s, steps, deadline_s
        self.interval_s = dt_s * steps
        self.request, self.configure_request = StepRequest, ConfigureRequest
        for service in ("configure", "step"):
            rospy.wait_for_service(f"{node}/{service}", 10)
        self.configure = rospy.ServiceProxy(f"{node}/configure", Configure, persistent=True)
        self.call = rospy.ServiceProxy(f"{node}/step", Step, persistent=True)
        self.run_id = random.SystemRandom().getrandbits(62) | 1
        self.reply_s = []

    def begin(self, version=None):
        """A new run, at time 0. @return the reply"""
        self.run_id += 1
        self.next = 0
        n, told = self.count, self.told
        request = self.configure_request(
            protocol_version=self.configure_request.PROTOCOL_VERSION if version is None else version,
            run_id=self.run_id,
            first_vehicle=told["first_vehicle"],
            vehicle_count=n,
            scenario=self.scenario,
            scenario_digest=text_digest(self.scenario),
            mass_kg=[told["mass_kg"]] * n,
            length_m=[told["length_m"]] * n,
            position_m=[-told["length_m"] * i for i in range(n)],
            speed_mps=[told["speed_mps"]] * n,
        )
        reply = self.configure(request)
        if reply.ok:
            self.take(reply)
        return reply

    def loads(self, forces, pressure_pa=0.0, exchange=None, run_id=None):
        return self.request(
            run_id=self.run_id if run_id is None else run_id,
            exchange=self.next if exchange is None else exchange,
            dt_s=self.dt_s,
            steps=self.steps,
            coupler_force_n=forces,
            cylinder_pressure_pa=[pressure_pa] * self.count,
        )

    def ask(self, request):
        began = time.monotonic()
        reply = self.call(request)
        self.reply_s.append(time.monotonic() - began)
        return reply

    def step(self, forces, pressure_pa=0.0):
        """The next exchange. @return the work of the couplers on the vehicles [J]"""
        before_m = self.x
        reply = self.ask(self.loads(forces, pressure_pa))
        if not reply.ok:
            raise Failure(f"exchange {self.next} was refused: {reply.message}")
        if reply.exchange != self.next:
            raise Failure(f"exchange {self.next} was answered as exchange {reply.exchange}")
        self.next += 1
        self.take(reply)
        return sum((forces[i] - forces[i + 1]) * (self.x[i] - before_m[i]) for i in range(self.count))

    def take(self, reply):
        for name in ("head_displacement_m", "head_velocity_mps"):
            values = getattr(reply, name)
            if len(values) != self.count:
                raise Failure(f"{name} has {len(values)} values, {self.count} are expected")
            for i, value in enumerate(values):
                if not math.isfinite(value):
                    raise Failure(
                        f"replied {name} = {value} for vehicle {self.told['first_vehicle'] + i}, "
                        f"{'at the start' if self.next == 0 else f'exchange {self.next - 1}'}"
                    )
        self.x, self.v = list(reply.head_displacement_m), list(reply.head_velocity_mps)

    def none(self):
        return [0.0] * (self.count + 1)

    def kinetic_j(self, v):
        return 0.5 * self.told["mass_kg"] * sum(u * u for u in v)

    def exchanges(self, seconds):
        return max(2, round(seconds / self.interval_s))


def text_digest(text):
    """As train_dynamics::TextDigest."""
    mask, factor = 2**64 - 1, 0xD6E8FEB86659FD93

    def mix(x):
        for _ in range(2):
            x = (x ^ (x >> 32)) * factor & mask
        return x ^ (x >> 32)

    data = text.encode()
    state = mix(0x9E3779B97F4A7C15 ^ len(data))
    for at in range(0, len(data), 8):
        state = mix(state ^ int.from_bytes(data[at : at + 8].ljust(8, b"\0"), "little"))
    return state


def random_loads(vehicles, seed, seconds):
    """Loads that change slowly against an exchange: [(coupler forces, cylinder pressure)]."""
    seeded = random.Random(seed)
    waves = [
        [(seeded.uniform(1e3, 2e4), seeded.uniform(0.2, 2.0), seeded.uniform(0, 6.28)) for _ in range(3)]
        for _ in range(vehicles.count + 1)
    ]
    loads = []
    for k in range(vehicles.exchanges(seconds)):
        t = k * vehicles.interval_s
        forces = [sum(a * math.sin(6.28 * f * t + p) for a, f, p in wave) for wave in waves]
        loads.append((forces, max(0.0, min(1.5e5, 5e4 * (t - seconds / 2)))))
    return loads


# ---- the tests: each returns what it has found, or raises Failure
# ------------------------------------------------------


def protocol(vehicles, seconds):
    del seconds
    reply = vehicles.begin()
    if not reply.ok:
        raise Failure(f"configure was refused: {reply.message}")
    wrong = [v for v in vehicles.v if abs(v - vehicles.told["speed_mps"]) > 1e-9]
    if wrong or any(vehicles.x):
        raise Failure(
            f"it starts with v = {vehicles.v} m/s and x = {vehicles.x} m, not with the declared "
            f"{vehicles.told['speed_mps']:g} m/s and 0 m"
        )
    if vehicles.begin(version=vehicles.configure_request.PROTOCOL_VERSION + 1).ok:
        raise Failure("another version of the protocol was accepted")
    vehicles.begin()
    vehicles.step(vehicles.none())
    for exchange, run_id, what in ((5, None, "an exchange that leaves a gap"), (None, 7, "an exchange of another run")):
        if vehicles.ask(vehicles.loads(vehicles.none(), exchange=exchange, run_id=run_id)).ok:
            raise Failure(f"{what} was accepted")
    return "starts as declared, refuses what is not its turn"


def refusal(vehicles, seconds):
    del seconds
    vehicles.begin()
    vehicles.step(vehicles.none())
    for value in (math.nan, math.inf):
        forces = vehicles.none()
        forces[-1] = value
        if vehicles.ask(vehicles.loads(forces)).ok:
            raise Failure(f"a coupler force of {value} was accepted")
    if vehicles.ask(vehicles.loads(vehicles.none(), pressure_pa=math.nan)).ok:
        raise Failure("a cylinder pressure of nan was accepted")
    vehicles.step(vehicles.none())
    return "NaN and infinity are refused, and the run goes on"


def repeat(vehicles, seconds):
    del seconds
    vehicles.begin()
    forces = [PULL_N * i for i in range(vehicles.count + 1)]
    vehicles.step(forces)
    x, v = vehicles.x, vehicles.v
    again = vehicles.ask(vehicles.loads(forces, exchange=0))
    if not again.ok or (list(again.head_displacement_m), list(again.head_velocity_mps)) != (x, v):
        raise Failure("the last exchange was asked for again and answered otherwise")
    vehicles.step(vehicles.none())
    return "the last exchange is answered again"


def series(vehicles, loads):
    vehicles.begin()
    motion = [(vehicles.x, vehicles.v)]
    for forces, pressure_pa in loads:
        vehicles.step(forces, pressure_pa)
        motion.append((vehicles.x, vehicles.v))
    return motion


def repeatability(vehicles, seconds):
    loads = random_loads(vehicles, 1, seconds / 2)
    if series(vehicles, loads) != series(vehicles, loads):
        raise Failure("the same loads gave other bits")
    return f"{len(loads)} exchanges twice: the same bits"


def velocity(vehicles, seconds):
    motion = series(vehicles, random_loads(vehicles, 2, seconds))
    pairs = list(zip(motion, motion[1:]))
    worst_m, turns_mps = 0.0, []
    for i in range(vehicles.count):
        for (x0, v0), (x1, v1) in pairs:
            worst_m = max(worst_m, abs(x1[i] - x0[i] - vehicles.interval_s * (v0[i] + v1[i]) / 2))
            turns_mps.append(abs(v1[i] - v0[i]))
    allowed_m = vehicles.interval_s * sorted(turns_mps)[9 * len(turns_mps) // 10] + EPSILON_M
    found = f"differs from the trapezoid by up to {worst_m:.2g} m in an exchange, {allowed_m:.2g} m are allowed"
    if worst_m > allowed_m:
        raise Failure(found)
    return found


def mean_speeds(vehicles, exchanges):
    sums = [0.0] * vehicles.count
    for _ in range(exchanges):
        vehicles.step(vehicles.none())
        sums = [a + b for a, b in zip(sums, vehicles.v)]
    return [a / exchanges for a in sums]


def passivity(vehicles, seconds):
    vehicles.begin()
    second = vehicles.exchanges(min(1.0, seconds / 10))
    before_j = vehicles.kinetic_j(mean_speeds(vehicles, second))
    work_j, turned_j = 0.0, 0.0
    for frequency_hz in (0.0, 1.0, 5.0):  # a pull of 1 kN on each vehicle, held and alternating
        for k in range(second):
            pull_n = PULL_N * math.cos(2 * math.pi * frequency_hz * k / second)
            done_j = vehicles.step([pull_n * (vehicles.count - i) for i in range(vehicles.count)] + [0.0])
            work_j += done_j
            turned_j += abs(done_j)
    energies_j = [vehicles.kinetic_j(mean_speeds(vehicles, second)) for _ in range(5)]
    allowed_j = PASSIVE * (before_j + turned_j) + 1e-6
    gain_j = max(
        energies_j[0] - before_j - work_j, *(after - before for before, after in zip(energies_j, energies_j[1:]))
    )
    found = f"gains at most {gain_j:.3g} J over the couplers' work, {allowed_j:.3g} J are allowed"
    if gain_j > allowed_j:
        raise Failure(found)
    return found


def effective_mass(vehicles):
    """Of each vehicle, F over acceleration of a step of 1 kN in one exchange [kg]."""
    masses = []
    for i in range(vehicles.count):
        v = []
        for force in (0.0, PULL_N):
            vehicles.begin()
            forces = vehicles.none()
            forces[: i + 1] = [force] * (i + 1)  # what pulls vehicle i alone
            vehicles.step(forces)
            v.append(vehicles.v[i])
        masses.append(PULL_N * vehicles.interval_s / (v[1] - v[0]) if v[1] != v[0] else math.inf)
    return masses


def mass(vehicles, seconds):
    del seconds
    masses, declared = effective_mass(vehicles), vehicles.told["mass_kg"]
    found = (
        f"a coupler head moves as a mass of {min(masses) / 1e3:.4g} to {max(masses) / 1e3:.4g} t, the vehicle has "
        f"{declared / 1e3:.4g} t"
    )
    if not all(0.2 * declared <= m <= 1.5 * declared for m in masses):
        raise Failure(found)
    return found


def stability(vehicles, seconds):
    del seconds
    lightest = min(effective_mass(vehicles))
    if not 0 < lightest < math.inf:
        raise Failure("there is no mass to judge by")
    limits = []
    for connection in vehicles.connections:
        k, c = connection["stiffness_n_per_m"], connection["damping_ns_per_m"]
        limits.append((lightest / (c + math.sqrt(c * c + k * lightest)), connection["name"]))
    if not limits:
        return "the train has no connection"
    limit_s, name = min(limits)
    found = f"exchanges of {1e3 * vehicles.interval_s:g} ms, {name} is stable to {1e3 * limit_s:.3g} ms with this mass"
    if vehicles.interval_s > limit_s:
        raise Failure(found)
    return found


def slow(vehicles, seconds):
    del seconds
    found = (
        f"{len(vehicles.reply_s)} exchanges, {1e3 * statistics.median(vehicles.reply_s):.3g} ms each (median), "
        f"{1e3 * max(vehicles.reply_s):.3g} ms at most"
    )
    if max(vehicles.reply_s) > vehicles.deadline_s:
        raise Failure(f"{found}; {vehicles.deadline_s:g} s are allowed")
    return found


TESTS = (protocol, refusal, repeat, repeatability, velocity, passivity, mass, stability, slow)


def judge(vehicles, seconds):
    """@return [(name of the test, whether it passed, what was found)]"""
    verdicts = []
    for test in TESTS:
        try:
            verdicts.append((test.__name__, True, test(vehicles, seconds)))
        except Failure as failure:
            finite = "finite" if "nan" in str(failure) and str(failure).startswith("replied") else test.__name__
            verdicts.append((finite, False, str(failure)))
    return verdicts


@contextlib.contextmanager
def built_in(namespace):
    """A wagon node of this program."""
    process = subprocess.Popen(
        [
            "rosrun",
            "wagon_node",
            "wagon_node",
            f"__ns:={namespace}",
            "__name:=vehicle_test_built_in",
            "_master_timeout_s:=0",
        ],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        yield f"{namespace}/vehicle_test_built_in"
    finally:
        os.killpg(process.pid, signal.SIGTERM)
        process.wait()


def differences(vehicles, other, seconds):
    loads = random_loads(vehicles, 3, seconds)
    pairs = list(zip(series(vehicles, loads), series(other, loads)))
    of = [max(abs(a - b) for one, two in pairs for a, b in zip(one[which], two[which])) for which in (0, 1)]
    return f"over {seconds:g} s of the same loads up to {of[0]:.3g} m and {of[1]:.3g} m/s from the built-in ltd model"


def train_sim(*words):
    done = subprocess.run(["rosrun", "train_sim", "train_sim", *words], stdout=subprocess.PIPE, text=True, check=False)
    return done.stdout if done.returncode == 0 else None


def main(words):
    if "-h" in words or "--help" in words:
        print(USAGE)
        return 0
    options = {"ns": "/train", "deadline_s": "1", "seconds": "10"}
    places = []
    for word in words:
        name, assigned, value = word.partition(":=")
        if assigned and name in options:
            options[name] = value
        elif assigned and not name.startswith("_"):
            print(f"vehicle_test: there is no {name}\n\n{USAGE}", file=sys.stderr)
            return 2
        elif not assigned:
            places.append(word)
    if len(places) not in (1, 2):
        print(USAGE, file=sys.stderr)
        return 2
    level = ("--set", "track={name: level}")
    check = train_sim("check", "--json", places[0], *level)
    if check is None:
        return 2
    told = json.loads(check)
    groups = [group for group in told["external"] if len(places) == 1 or group["node"] == places[1]]
    if len(groups) != 1:
        names = ", ".join(group["node"] for group in told["external"]) or "none"
        print(f"vehicle_test: name one of the nodes that move external vehicles: {names}", file=sys.stderr)
        return 2
    group = groups[0]
    scenario = train_sim("resolve", places[0], *level)
    of_group = f"train.consist[{group['group']}]"
    own = train_sim("resolve", places[0], *level, "--set", f'{of_group}.external=""', "--set", f"{of_group}.model=ltd")

    import rospy

    rospy.init_node("vehicle_test", anonymous=True, disable_rostime=True)
    seconds, dt_s = float(options["seconds"]), told["dt_s"]
    steps = round(told["exchange_interval_s"] / dt_s)
    node = rospy.names.ns_join(options["ns"], group["node"])
    try:
        vehicles = Vehicles(node, scenario, group, dt_s, steps, float(options["deadline_s"]))
    except rospy.ROSException as error:
        print(f"vehicle_test: {node} is not there: {error}", file=sys.stderr)
        return 2
    vehicles.connections = told["connections"]
    try:
        verdicts = judge(vehicles, seconds)
    except rospy.ServiceException as error:
        verdicts = [("protocol", False, f"a call failed: {error}")]
    print(f"{node}: {group['vehicles']} vehicle(s) of {group['mass_kg'] / 1e3:g} t")
    for name, passed, found in verdicts:
        print(f"  {'passed' if passed else 'FAILED'}  {name:13}  {found}")
    if all(passed for _, passed, _ in verdicts):
        with built_in(options["ns"]) as beside:
            print(
                "  beside it              "
                + differences(
                    vehicles, Vehicles(beside, own, group, dt_s, steps, float(options["deadline_s"])), seconds
                )
            )
        return 0
    return 1
