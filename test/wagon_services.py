#!/usr/bin/python3
"""A wagon node as any ROS user meets it: plain service calls, the topic of a vehicle, the end of the ROS master."""
import io
import math
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import rosgraph
import rospy
import rosservice
import rostest
from train_brake_msgs.msg import WagonState
from train_brake_msgs.srv import Configure, ConfigureRequest, Step, StepRequest

NODE = "/train/wagon_001"
WORD = 2**64 - 1


def text_digest(text):
    """The digest of lockstep.h, by its description."""

    def mix(x):
        for _ in range(2):
            x = ((x ^ (x >> 32)) * 0xD6E8FEB86659FD93) & WORD
        return x ^ (x >> 32)

    data = text.encode()
    state = mix(0x9E3779B97F4A7C15 ^ len(data))
    for begin in range(0, len(data), 8):
        state = mix(state ^ int.from_bytes(data[begin : begin + 8], "little"))
    return state


def resolved_scenario():
    """The scenario as the master sends it, with all parts in place."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(
            ["rosrun", "train_sim", "train_sim", "run", rospy.get_param("~scenario"), "--out", folder],
            check=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        return (pathlib.Path(folder) / "config.yaml").read_text()


class WagonServices(unittest.TestCase):
    run_id = 2**63 + 5  # it uses all of its 64 bits

    @classmethod
    def setUpClass(cls):
        cls.scenario = resolved_scenario()
        rospy.wait_for_service(NODE + "/step", 600)
        cls.configure = rospy.ServiceProxy(NODE + "/configure", Configure, persistent=True)
        cls.step = rospy.ServiceProxy(NODE + "/step", Step, persistent=True)

    def configure_request(self, **changes):
        request = ConfigureRequest(
            protocol_version=ConfigureRequest.PROTOCOL_VERSION,
            run_id=self.run_id,
            first_vehicle=1,
            vehicle_count=2,
            scenario=self.scenario,
            scenario_digest=text_digest(self.scenario),
        )
        for key, value in changes.items():
            setattr(request, key, value)
        return request

    def step_request(self, exchange, **changes):
        request = StepRequest(
            run_id=self.run_id,
            exchange=exchange,
            dt_s=0.001,
            steps=2,
            coupler_force_n=[0.0, 1e4, 2e4],
            cylinder_pressure_pa=[1e5, 2e5],
        )
        for key, value in changes.items():
            setattr(request, key, value)
        return request

    def begin(self):
        type(self).run_id += 1  # each test is a run of its own, by the same master
        reply = self.configure(self.configure_request(run_id=self.run_id))
        self.assertTrue(reply.ok, reply.message)
        return reply

    def refused(self, reply, text):
        self.assertFalse(reply.ok)
        self.assertIn(text, reply.message)

    def test_configure_brings_the_vehicles_to_time_0(self):
        reply = self.begin()
        self.assertEqual(reply.message, "vehicles 1-2 of 6, scenario short_train, run %d" % self.run_id)
        self.assertEqual(reply.scenario_digest, text_digest(self.scenario))
        self.assertEqual(len(reply.head_velocity_mps), 2)
        for speed in reply.record.speed_mps:
            self.assertAlmostEqual(speed, 80 / 3.6, places=12)
        self.assertEqual([detail.vehicle for detail in reply.record.details], [1])

    def test_wrong_version_and_digest_are_refused_with_both_values(self):
        self.refused(
            self.configure(self.configure_request(protocol_version=99)),
            "the master speaks protocol version 99, this wagon node version %d" % ConfigureRequest.PROTOCOL_VERSION,
        )
        self.refused(
            self.configure(self.configure_request(scenario_digest=1)),
            "digest 0x0000000000000001, but has 0x%016x" % text_digest(self.scenario),
        )

    def test_a_step_moves_and_its_repetition_does_not(self):
        self.begin()
        first = self.step(self.step_request(0, run_id=self.run_id, record=True, ledger=True))
        self.assertTrue(first.ok, first.message)
        self.assertEqual(self.step(self.step_request(0, run_id=self.run_id)), first)
        self.refused(
            self.step(self.step_request(0, run_id=self.run_id, cylinder_pressure_pa=[0.0, 0.0])),
            "exchange 0 has been computed already, with other loads",
        )
        # About 22.2 m/s for 2 ms; brake and couplers change the speed by far less than 1 % in that time.
        for distance in first.head_displacement_m:
            self.assertAlmostEqual(distance, 80 / 3.6 * 0.002, delta=0.01 * 80 / 3.6 * 0.002)
        second = self.step(self.step_request(1, run_id=self.run_id))
        self.assertTrue(second.ok, second.message)
        self.assertFalse(second.record.state_digest)

    def test_gaps_and_the_past_are_refused_with_both_numbers(self):
        self.begin()
        for exchange in range(3):
            self.assertTrue(self.step(self.step_request(exchange, run_id=self.run_id)).ok)
        self.refused(self.step(self.step_request(4, run_id=self.run_id)), "exchange 4 leaves a gap: exchange 3 is next")
        self.refused(self.step(self.step_request(1, run_id=self.run_id)), "exchange 1 is past: exchange 3 is next")
        self.assertTrue(self.step(self.step_request(3, run_id=self.run_id)).ok)

    def test_what_is_not_finite_or_of_a_wrong_size_is_refused(self):
        self.begin()
        self.refused(
            self.step(self.step_request(0, run_id=self.run_id, coupler_force_n=[0.0, math.nan, 0.0])),
            "coupler_force_n[1] is nan",
        )
        self.refused(
            self.step(self.step_request(0, run_id=self.run_id, cylinder_pressure_pa=[0.0])),
            "cylinder_pressure_pa has 1 values, expected 2",
        )
        self.assertTrue(self.step(self.step_request(0, run_id=self.run_id)).ok)

    def test_another_run_changes_nothing(self):
        self.begin()
        self.assertTrue(self.step(self.step_request(0, run_id=self.run_id)).ok)
        self.refused(self.step(self.step_request(1, run_id=99)), "run 99 is not known here")
        # Another client, from the command line, while we are connected.
        arguments = (
            "{protocol_version: %d, run_id: 99, first_vehicle: 1, vehicle_count: 1, scenario: '', "
            "scenario_digest: %d}" % (ConfigureRequest.PROTOCOL_VERSION, text_digest(""))
        )
        call = subprocess.run(
            ["rosservice", "call", NODE + "/configure", arguments],
            stdout=subprocess.PIPE,
            universal_newlines=True,
            check=True,
        )
        self.assertIn("ok: False", call.stdout)
        self.assertIn("driven in another run", call.stdout)
        self.assertNotIn(str(self.run_id), call.stdout)
        self.assertTrue(self.step(self.step_request(1, run_id=self.run_id)).ok)

    def test_detailed_vehicles_are_published(self):
        self.begin()
        received = []
        subscriber = rospy.Subscriber("/train/wagon_001/state", WagonState, received.append)
        deadline = time.time() + 20
        while subscriber.get_num_connections() == 0 and time.time() < deadline:
            time.sleep(0.05)
        reply = self.step(self.step_request(0, run_id=self.run_id, record=True))
        # The state at the start is latched: who comes later has it, too.
        while (not received or received[-1].exchange == 0) and time.time() < deadline:
            time.sleep(0.05)
        self.assertEqual(received[-1].exchange, 1)
        self.assertEqual(received[-1].header.stamp.to_sec(), 0.002)
        self.assertEqual(received[-1].body_x_m, reply.record.details[0].body_x_m)

    def test_services_are_what_rosservice_shows(self):
        self.assertEqual(rosservice.get_service_type(NODE + "/configure"), "train_brake_msgs/Configure")
        self.assertEqual(rosservice.get_service_type(NODE + "/step"), "train_brake_msgs/Step")

    def test_rosservice_steps_a_train_by_hand(self):
        self.begin()
        arguments = (
            "{run_id: %d, exchange: 0, dt_s: 0.001, steps: 2, coupler_force_n: [0, 0, 0], "
            "cylinder_pressure_pa: [0, 0]}" % self.run_id
        )
        call = subprocess.run(
            ["rosservice", "call", NODE + "/step", arguments],
            stdout=subprocess.PIPE,
            universal_newlines=True,
            check=True,
        )
        self.assertIn("ok: True", call.stdout)
        self.assertTrue(self.step(self.step_request(1, run_id=self.run_id)).ok)

    # ---- TCPROS, byte by byte ----

    def connect(self, **fields):
        """A connection to ~step, and the header that came back."""
        host, port = rosservice.get_service_uri(NODE + "/step")[len("rosrpc://") :].split(":")
        connection = socket.create_connection((host, int(port)), 10)
        self.addCleanup(connection.close)
        header = {
            "callerid": "/stranger",
            "service": NODE + "/step",
            "md5sum": Step._md5sum,
            "persistent": "1",
            **fields,
        }
        lines = [f"{key}={value}".encode() for key, value in header.items()]
        connection.sendall(frame(b"".join(frame(line) for line in lines)))
        return connection, read_frame(connection)

    def serialised(self, exchange):
        buffer = io.BytesIO()
        self.step_request(exchange, run_id=self.run_id).serialize(buffer)
        return buffer.getvalue()

    def reply(self, connection):
        is_served = read_exactly(connection, 1) == b"\x01"
        payload = read_frame(connection)
        return Step._response_class().deserialize(payload) if is_served else payload.decode()

    def test_other_definitions_are_refused_by_the_header(self):
        connection, header = self.connect(md5sum="0" * 32)
        self.assertIn(b"error=client wants service " + NODE.encode() + b"/step to have md5sum 000", header)
        self.assertEqual(b"", connection.recv(1))
        _, header = self.connect(md5sum="*", probe="1")
        self.assertIn(b"type=train_brake_msgs/Step", header)

    def test_requests_may_come_in_pieces_or_at_once(self):
        self.begin()
        connection, _ = self.connect()
        for byte in frame(self.serialised(0)):
            connection.sendall(bytes([byte]))
        self.assertTrue(self.reply(connection).ok)
        connection.sendall(frame(self.serialised(1)) + frame(self.serialised(2)) + frame(self.serialised(2)))
        for exchange in (1, 2, 2):
            reply = self.reply(connection)
            self.assertTrue(reply.ok, reply.message)
            self.assertEqual(exchange, reply.exchange)

    def test_who_does_not_persist_is_let_go(self):
        self.begin()
        connection, _ = self.connect(persistent="0")
        connection.sendall(frame(self.serialised(0)))
        self.assertTrue(self.reply(connection).ok)
        self.assertEqual(b"", connection.recv(1))

    def test_nonsense_is_answered_and_changes_nothing(self):
        self.begin()
        request = self.serialised(0)
        connection, _ = self.connect()
        huge_array = request[:31] + b"\xff\xff\xff\xff" + request[35:]  # after run_id ... snapshot
        for nonsense in (b"", b"x", request[:-1], request + b"x", huge_array):
            connection.sendall(frame(nonsense))
            self.assertIsInstance(self.reply(connection), str)  # not served, and why
        connection.sendall(frame(request))
        self.assertTrue(self.reply(connection).ok)

    def test_whoever_speaks_no_tcpros_is_cut_off(self):
        self.begin()
        host, port = rosservice.get_service_uri(NODE + "/step")[len("rosrpc://") :].split(":")
        for greeting in (b"GET / HTTP/1.1\r\n\r\n", frame(b"no header"), b"\xff" * 100):
            with socket.create_connection((host, int(port)), 10) as connection:
                connection.sendall(greeting)
                self.assertEqual(b"", connection.recv(1))
        connection, _ = self.connect()
        connection.sendall(b"\xff\xff\xff\xff")  # a request of 4 GiB
        self.assertEqual(b"", connection.recv(1))
        silent, _ = self.connect()  # and stays: no call waits for it
        self.assertTrue(self.step(self.step_request(0, run_id=self.run_id)).ok)

    def test_whoever_does_not_read_replies_holds_up_nobody_else(self):
        self.begin()
        connection, _ = self.connect()
        connection.setblocking(False)
        request = frame(self.serialised(0))
        with self.assertRaises(BlockingIOError):
            for _ in range(10**6):
                connection.sendall(request)
        self.assertTrue(self.step(self.step_request(0, run_id=self.run_id)).ok)
        self.assertTrue(self.step(self.step_request(1, run_id=self.run_id)).ok)

    # ---- the ROS master ----

    def test_a_node_without_a_ros_master_leaves(self):
        port = free_port()
        environment = dict(os.environ, ROS_MASTER_URI="http://localhost:%d" % port)
        core = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], env=environment, stdout=subprocess.DEVNULL)
        try:
            uri = environment["ROS_MASTER_URI"]
            wait_until(lambda: rosgraph.is_master_online(uri))
            wagon = subprocess.Popen(["rosrun", "wagon_node", "wagon_node", "_master_timeout_s:=1"], env=environment)
            master = rosgraph.Master("/test", uri)
            wait_until(lambda: any(name == "/wagon/step" for name, _ in master.getSystemState()[2]))
            time.sleep(3)  # three times its patience, without any request
            self.assertIsNone(wagon.poll())
            core.send_signal(signal.SIGKILL)
            wagon.wait(600)
        finally:
            core.kill()
            core.wait()


def frame(payload):
    return struct.pack("<I", len(payload)) + payload


def read_exactly(connection, size):
    data = b""
    while len(data) < size:
        piece = connection.recv(size - len(data))
        if not piece:
            raise EOFError
        data += piece
    return data


def read_frame(connection):
    return read_exactly(connection, struct.unpack("<I", read_exactly(connection, 4))[0])


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def wait_until(condition, wall_s=20):
    deadline = time.time() + wall_s
    while not condition():
        if time.time() > deadline:
            raise AssertionError("waited for %s s in vain" % wall_s)
        time.sleep(0.1)


if __name__ == "__main__":
    rospy.init_node("wagon_services_test")
    rostest.rosrun("train_brake", "wagon_services", WagonServices, sys.argv)
