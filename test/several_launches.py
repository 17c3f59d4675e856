#!/usr/bin/python3
"""Launches beside others, and those who come late: names, clocks, paths and parameters under one ROS master."""
import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import time

import rosbag
import rosgraph
import rosunit

from launches import SHORT_TRAIN, Launch, LaunchTest, messages, train_sim, wait_until

SOON = 30.0


class SeveralLaunches(LaunchTest):
    def launch(self, name, *arguments, namespace=None, **options):
        folder = self.folder / name
        folder.mkdir()
        environment = dict(self.master.environment, **({"ROS_NAMESPACE": namespace} if namespace else {}))
        proxy = type("Master", (), {"environment": environment})
        return Launch(
            proxy,
            folder,
            ("train_brake", "train.launch"),
            f"scenario:={SHORT_TRAIN}",
            "vehicles:=6",
            *arguments,
            **options,
        )

    def node(self, *arguments):
        """ltd_master by hand, to its end. @return exit code and log"""
        done = subprocess.run(
            ["rosrun", "ltd_master", "ltd_master", "__ns:=/train", "__name:=master", *arguments],
            env=self.master.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=60,
        )
        return done.returncode, done.stdout

    def call(self, service, *arguments):
        return self.tool("rosservice", "call", service, *arguments)

    def wait_for_service(self, service):
        self.assertTrue(wait_until(lambda: service in self.master.services(), SOON), service)

    def get_parameter(self, name):
        master = rosgraph.Master("/test", self.master.uri)
        return master.getParam(name) if master.hasParam(name) else None

    def publishers(self, topic):
        state = rosgraph.Master("/test", self.master.uri).getSystemState()[0]
        return {node for name, nodes in state for node in nodes if name == topic}

    def test_a_second_launch_is_refused_and_the_first_goes_on(self):
        settings = "duration_s=6"
        first = self.launch("first", f"set:={settings}", "real_time_factor:=1", "nodes:=2")
        first.saw(r" 1\.\d+ of 6 s", SOON)
        second = self.launch("second", "nodes:=3")  # one of its wagon nodes has the name of one of the first's
        self.assertEqual(2, second.ended())
        for text in (
            "/train/master runs already",
            f"{SHORT_TRAIN}, since 20",
            "ROS_NAMESPACE=",
            "/train/wagon_001 runs already",
        ):
            self.assertIn(text, second.log())
        self.assertFalse(second.out.exists())
        self.assertLess(second.log().count("process[train/wagon_001"), 2, "it is started again and again")
        self.assertEqual(0, first.ended(), first.log())
        self.assertNotIn("WARN", first.log())
        with tempfile.TemporaryDirectory() as folder:
            expected = train_sim("--out", folder, "--set", settings)
            self.assertEqual(expected["state_digest"], first.summary()["state_digest"])
            self.assertTrue(first.bag() == messages(f"{folder}/train.bag"))

    def test_the_name_of_a_dead_process_is_free(self):
        first = self.launch("first", "nodes:=1", "start_paused:=true")
        self.wait_for_service("/train/master/step")
        subprocess.run(["kill", "-9", str(self.master.process_of("master"))], check=True)
        first.process.wait(60)
        self.assertIn("/train/master/step", self.master.services())  # the ROS master does not know
        self.assertEqual(0, self.launch("second", "nodes:=1").ended())

    def test_two_trains_have_a_clock_each(self):
        arguments = ("set:=duration_s=4", "real_time_factor:=1", "nodes:=1", "start_paused:=true")
        plain = self.launch("plain", *arguments)
        self.wait_for_service(
            "/train/master/resume"
        )  # roslaunch ends of two that make the run_id of a ROS master at once
        north = self.launch("north", *arguments, namespace="north")
        self.wait_for_service("/north/train/master/resume")
        self.assertEqual({"/train/master"}, self.publishers("/clock"))
        self.assertEqual({"/train/master"}, self.publishers("/train/clock"))
        self.assertEqual({"/north/train/master"}, self.publishers("/north/train/clock"))
        self.assertIs(True, self.get_parameter("/use_sim_time"))
        self.assertIs(True, self.get_parameter("/north/train/use_sim_time"))
        self.assertIn("success: True", self.call("/train/master/step", "50"))
        self.assertRegex(
            self.tool("rostopic", "echo", "-n1", "/north/train/clock"), r"nsecs: +1\n"
        )  # 0 is "no time yet"
        self.assertRegex(self.tool("rostopic", "echo", "-n1", "/clock"), r"nsecs: +100000000\n")
        third = self.launch("third", "global_clock:=true", "nodes:=1", namespace="south")
        self.assertEqual(2, third.ended())
        self.assertIn("/train/master publishes /clock already", third.log())
        for namespace in ("/train", "/north/train"):
            self.call(namespace + "/master/resume")
        self.assertEqual((0, 0), (plain.ended(), north.ended()))
        self.assertIsNone(self.get_parameter("/use_sim_time"))
        self.assertIsNone(self.get_parameter("/north/train/use_sim_time"))

    def test_who_comes_in_a_pause_has_the_time_and_the_record(self):
        launch = self.launch("run", "nodes:=2", "start_paused:=true")
        self.wait_for_service("/train/master/step")
        self.call("/train/master/step", "35")  # seven records
        time.sleep(0.5)
        for topic in ("/train/live/state", "/train/live/status", "/train/state"):
            self.assertIn("35", self.tool("rostopic", "echo", "-n1", topic + "/exchange"), topic)
        late = (
            "import rospy, time; rospy.init_node('late'); time.sleep(1); "
            "rospy.loginfo('at %.3f', rospy.Time.now().to_sec())"
        )
        self.assertIn("at 0.070", self.tool("/usr/bin/python3", "-c", late))
        self.call("/train/master/resume")
        self.assertEqual(0, launch.ended(), launch.log())

    def test_a_recorder_that_comes_before_the_start_has_every_record(self):
        launch = self.launch("run", "nodes:=1", "start_paused:=true", "set:=duration_s=3")
        self.wait_for_service("/train/master/resume")
        bag = self.folder / "beside.bag"
        recorder = subprocess.Popen(
            ["rosbag", "record", "-q", "-O", str(bag), "/train/state", "__name:=beside"],
            env=self.master.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self.assertTrue(wait_until(lambda: pathlib.Path(f"{bag}.active").exists(), SOON))
        self.call("/train/master/set_real_time_factor", "1")
        self.call("/train/master/resume")
        self.assertEqual(0, launch.ended(), launch.log())
        recorder.send_signal(2)
        recorder.wait(30)
        self.assertTrue(wait_until(bag.exists, SOON))
        with rosbag.Bag(str(bag)) as recorded:
            exchanges = [message.exchange for _, message, _ in recorded.read_messages("/train/state")]
        with rosbag.Bag(str(launch.out / "train.bag")) as whole:
            expected = [message.exchange for _, message, _ in whole.read_messages("/train/state")]
        self.assertEqual(expected, exchanges)

    def test_a_pause_ends_a_long_step(self):
        launch = self.launch("run", "nodes:=1", "start_paused:=true", "real_time_factor:=1", "set:=duration_s=30")
        self.wait_for_service("/train/master/step")
        step = subprocess.Popen(
            ["rosservice", "call", "/train/master/step", "10000"],
            env=self.master.environment,
            stdout=subprocess.PIPE,
            text=True,
        )
        time.sleep(2)
        stands = re.search(r"paused at (\d+\.\d+) s", self.call("/train/master/pause"))
        self.assertTrue(stands)
        self.assertRegex(
            step.communicate(timeout=20)[0], r"success: False\s+message: .paused after \d+ of 10000 exchanges"
        )
        time.sleep(1)
        self.assertIn(f"was paused already, at {stands[1]} s", self.call("/train/master/pause"))
        launch.interrupt()
        self.assertEqual(130, launch.ended())

    def test_parameters_are_as_strict_as_files(self):
        code, log = self.node(
            f"_scenario:={SHORT_TRAIN}", "_record:=no", "_real_time_factor:=fast", "_out:=5", "_realtime_factor:=2"
        )
        self.assertEqual(2, code, log)
        for text in (
            "record must be true or false, got the text 'no'",
            "real_time_factor must be a plain number",
            "out must be text, got 5",
            "realtime_factor is not known; did you mean real_time_factor?",
        ):
            self.assertIn(text, log)
        done = subprocess.run(
            ["rosrun", "wagon_node", "wagon_node", "_threads:=two", "_thread:=2"],
            env=self.master.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=30,
        )
        self.assertEqual(2, done.returncode)
        self.assertIn("threads must be an integer, got the text 'two'", done.stdout)
        self.assertIn("thread is not known; did you mean threads?", done.stdout)
        done = subprocess.run(
            ["rosrun", "train_brake_rviz", "train_view", "_live:=perhaps"],
            env=self.master.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=30,
        )
        self.assertEqual(2, done.returncode)
        self.assertIn("live must be true or false, got the text 'perhaps'", done.stdout)

    def test_nodes_log_with_wall_time_where_nobody_publishes_a_clock(self):
        self.tool("rosparam", "set", "/use_sim_time", "true")
        for package, program in (("ltd_master", "ltd_master"), ("wagon_node", "wagon_node")):
            log = self.tool("rosrun", package, program, "_nonsense:=1")
            self.assertRegex(log, r"\[FATAL\] \[1\d{9}\.\d+\]: parameter nonsense is not known", log)

    def test_parameters_of_others_are_told(self):
        self.tool("rosparam", "set", "/train/master/record", "false")
        code, log = self.node(f"_scenario:={SHORT_TRAIN}", "_model:=ltd")
        self.assertEqual(0, code, log)
        self.assertIn("were on the ROS master before, and are used: record", log)

    def test_an_exit_status_file_that_cannot_be_written_is_told(self):
        status = self.folder / "status"
        link = self.folder / "link"
        link.symlink_to(status)
        run = f"_scenario:={SHORT_TRAIN}", "_model:=ltd", "_ranks:=0"
        for unusable, why in (
            (self.folder / "absent" / "status", "No such file or directory"),
            (self.folder, "is not a regular file"),
            ("/dev/stdout", "(is not a regular file|cannot make canonical path)"),
        ):
            code, log = self.node(*run, "_set:=duration_s=0.1", f"_exit_status_file:={unusable}")
            self.assertEqual(2, code, log)
            self.assertRegex(log, f"exit_status_file: .*{why}.*nothing was started")
        # What an earlier run left is not taken for this one's, and a link stays one.
        status.write_text("0\n")
        code, log = self.node("_scenario:=absent.yaml", "_ranks:=0", f"_exit_status_file:={link}")
        self.assertEqual((2, "2\n"), (code, status.read_text()), log)
        self.assertTrue(link.is_symlink())
        # A folder that goes away during the run.
        folder = self.folder / "gone"
        folder.mkdir()
        paced = subprocess.Popen(
            ["rosrun", "ltd_master", "ltd_master", "__ns:=/train", "__name:=master", *run, "_set:=duration_s=3"]
            + ["_real_time_factor:=1", f"_exit_status_file:={folder}/status"],
            env=self.master.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.wait_for_service("/train/master/pause")
        folder.rmdir()
        log = paced.communicate(timeout=60)[0]
        self.assertEqual(1, paced.returncode, log)
        self.assertIn(f"cannot write {folder}/status", log)

    def test_numbers_of_nodes_and_threads_are_whole_and_refused_at_once(self):
        for name, value, rule in (
            ("nodes", "0", "must be auto or a whole number >= 1, got the text '0'"),
            ("nodes", "-1", "must be auto or a whole number >= 1, got the text '-1'"),
            ("nodes", "1.5", "must be auto or a whole number >= 1, got the text '1.5'"),
            ("threads", "0", "must be >= 1, got 0"),
        ):
            launch = self.launch(name + value, f"{name}:={value}", "startup_timeout:=0")
            self.assertEqual(2, launch.ended(), launch.log())
            self.assertIn(f"parameter {name} {rule}", launch.log())

    def test_nodes_that_are_not_used_are_told(self):
        launch = self.launch("run", "model:=ltd", "nodes:=4", "on_lost_driver:=hold")
        self.assertEqual(0, launch.ended(), launch.log())
        self.assertIn("nodes:=4 is not used: all vehicles are in the master", launch.log())
        self.assertRegex(launch.log(), "on_lost_driver, .* are not used: there is no driver")

    def test_the_model_of_the_scenario_is_taken_and_needless_nodes_are_told(self):
        launch = self.launch("ltd", "set:=model=ltd", "nodes:=9")
        self.assertEqual(0, launch.ended(), launch.log())
        self.assertIn("no vehicle of this train is 2d: on 6 wagon nodes it runs slower", launch.log())
        self.assertIn("nodes:=9 is not used: the train has 6 vehicles and runs on 6 wagon nodes", launch.log())

    def test_paths_are_those_of_the_caller(self):
        caller, home = self.folder / "caller", self.folder / "home"
        caller.mkdir()
        home.mkdir()
        (caller / "mine.yaml").write_text(f"base: {SHORT_TRAIN}\n")
        config = SHORT_TRAIN.parent.parent / "config"
        environment = dict(self.master.environment, HOME=str(home), PWD=str(caller), TRAIN_BRAKE_CONFIG=str(config))
        for out, place in (("runs/one", caller / "runs" / "one"), ("~/two", home / "two")):
            done = subprocess.run(
                [
                    "roslaunch",
                    "train_brake",
                    "train.launch",
                    "scenario:=mine.yaml",
                    "vehicles:=6",
                    "nodes:=1",
                    f"out:={out}",
                    "exit_status_file:=status",
                ],
                cwd=caller,
                env=environment,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                timeout=60,
            )
            self.assertTrue((place / "summary.json").exists(), done.stdout)
            self.assertIn(f"results go to {place}", done.stdout)
            self.assertEqual("0\n", (caller / "status").read_text())
            (caller / "status").unlink()
        self.assertFalse((caller / "~").exists())

    def run_command(self, *words, folder):
        done = subprocess.run(
            ["rosrun", "train_brake", "run", *words, "report:=false"],
            cwd=folder,
            env=self.master.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=120,
        )
        return done.returncode, done.stdout

    def test_run_finds_the_vehicles_and_returns_the_run_s_code_without_red_lines(self):
        caller = self.folder / "caller"
        caller.mkdir()
        (caller / "mine.yaml").write_text(f"base: {SHORT_TRAIN}\nduration_s: 0.1\n")
        code, log = self.run_command("mine.yaml", "runs/one", "nodes:=2", folder=caller)
        self.assertEqual(0, code, log)
        self.assertNotIn("\033[31m", log)
        self.assertNotIn("REQUIRED", log)
        summary = json.loads((caller / "runs" / "one" / "summary.json").read_text())
        self.assertIs(True, summary["complete"])
        self.assertEqual(6, summary["vehicles"])
        self.assertEqual({}, self.master.processes())  # nothing is left behind
        branch = self.run_command("runs/two", "resume:=runs/one", "set:=duration_s=0.12", folder=caller)
        self.assertEqual(0, branch[0], branch[1])

    def test_run_needs_nobody_who_reads_what_it_tells(self):
        # As for a user: Python writes its buffer once more at its end, unless it has none.
        environment = {k: v for k, v in self.master.environment.items() if k != "PYTHONUNBUFFERED"}
        words = f"rosrun train_brake run {SHORT_TRAIN} unread set:=duration_s=0.1"
        for redirection in (">/dev/full 2>&1", ">&- 2>&-", "<&- >&- 2>&-", "> >(true) 2>&1"):
            done = subprocess.run(
                ["bash", "-c", f"{words} {redirection}"], cwd=self.folder, env=environment, timeout=120, check=False
            )
            self.assertEqual(0, done.returncode, redirection)
            (self.folder / "unread" / "summary.json").unlink()
            (self.folder / "unread" / "report.html").unlink()

    def test_a_machine_that_does_not_know_its_own_name_goes_by_localhost(self):
        elsewhere = ["unshare", "--uts", "bash", "-c", 'hostname nowhere.invalid && exec "$@"', "bash"]
        if subprocess.run([*elsewhere, "true"], stderr=subprocess.DEVNULL, check=False).returncode:
            self.skipTest("only root can give this process's machine another name")
        environment = {k: v for k, v in self.master.environment.items() if k not in ("ROS_HOSTNAME", "ROS_IP")}
        done = subprocess.run(
            [*elsewhere, "rosrun", "train_brake", "run", str(SHORT_TRAIN), "set:=duration_s=0.1", "report:=false"],
            cwd=self.folder,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=600,
        )
        self.assertEqual(0, done.returncode, done.stdout)
        self.assertIn("this machine's name, nowhere.invalid, leads nowhere: nodes use localhost", done.stdout)

    def test_vehicles_0_is_any_train_in_the_master(self):
        launch = self.launch("all", "vehicles:=0", "set:=duration_s=0.2")
        self.assertEqual(0, launch.ended(), launch.log())
        summary = json.loads((launch.out / "summary.json").read_text())
        self.assertEqual(train_sim("--set", "duration_s=0.2")["state_digest"], summary["state_digest"])
        self.assertIn(
            "all 6 vehicles are in the master, on one core; vehicles:=6 puts them on wagon nodes", launch.log()
        )
        self.assertIn(f"6 vehicles, 2d model, ends after 0.2 s and {summary['distance_m']:.1f} m", launch.log())

    def test_run_returns_2_for_what_it_cannot_use(self):
        for words, told in (
            (["absent.yaml"], "does not exist"),
            ([], "SCENARIO is missing"),
            ([str(SHORT_TRAIN), "out", "nonsense:=1"], "nonsense"),
            ([str(SHORT_TRAIN), "out", "more"], "one too many"),
            ([str(SHORT_TRAIN), "out", "model:=3d"], "3d"),
        ):
            code, log = self.run_command(*words, folder=self.folder)
            self.assertEqual(2, code, log)
            self.assertIn(told, log)
        code, log = self.run_command(
            str(SHORT_TRAIN), "nodes:=2", "startup_timeout:=2", "vehicles:=5", folder=self.folder
        )
        self.assertEqual(2, code, log)  # the master counts for itself

    def test_set_carries_blanks_lists_and_maps(self):
        settings = 'set:=name="two words" detail_vehicles=[1, 3] duration_s=0.1'
        launch = self.launch("run", settings, "nodes:=1")
        self.assertEqual(0, launch.ended(), launch.log())
        config = (launch.out / "config.yaml").read_text()
        self.assertIn("two words", config)
        self.assertIn("/train/wagon_003/state", launch.bag())
        refused = self.launch("refused", "set:=name=two words")
        self.assertEqual(2, refused.ended())
        self.assertIn('as in name="two words"', refused.log())

    def test_examples_in_messages_can_be_given(self):
        scenario = ("check", str(SHORT_TRAIN))
        vehicle = ("modes", str(SHORT_TRAIN.parent.parent / "config" / "vehicles" / "ore_wagon.yaml"))
        for command in (scenario, vehicle):
            run = lambda setting, command=command: subprocess.run(
                ["rosrun", "ltd_master", "train_sim", *command, "--set", setting],
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
            example = re.search(r"as in (\S+)", run("nonsense").stdout)
            self.assertTrue(example)
            done = run(example[1])
            self.assertEqual(0, done.returncode, done.stdout)

    def test_after_a_restart_of_the_ros_master_everything_is_found_again(self):
        launch = self.launch("run", "nodes:=1", "start_paused:=true")
        self.wait_for_service("/train/master/step")
        self.call("/train/master/step", "5")
        self.master.kill()
        launch.saw("the ROS master at .* is gone", SOON)
        self.master.start()
        launch.saw("topics and services are registered again", SOON)
        self.wait_for_service("/train/master/step")
        self.assertIs(True, self.get_parameter("/use_sim_time"))
        self.assertRegex(self.tool("rostopic", "echo", "-n1", "/clock"), r"nsecs: +10000000\n")
        self.wait_for_service("/train/wagon_001/configure")
        self.assertIn("/train/wagon_001/step", self.master.services())
        self.call("/train/master/resume")
        self.assertEqual(0, launch.ended(), launch.log())

    def test_setup_finds_shipped_parts_behind_own_ones_and_a_name_twice_is_told(self):
        shipped = SHORT_TRAIN.parent.parent / "config"
        own = self.folder / "own"
        (own / "scenarios").mkdir(parents=True)
        scenario = shutil.copy(shipped / "scenarios" / "dip.yaml", own / "scenarios")
        check = lambda: subprocess.run(
            ["rosrun", "ltd_master", "train_sim", "check", str(scenario)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        done = check()
        self.assertEqual(0, done.returncode, done.stdout)
        self.assertNotIn("same name", done.stdout)
        part = next((shipped / "trains").glob("single*.yaml"), None)
        train = re.search(r"^train: (\w+)", (shipped / "scenarios" / "dip.yaml").read_text(), re.M)
        part = shipped / "trains" / f"{train[1]}.yaml" if train else part
        (own / "trains").mkdir()
        shutil.copy(part, own / "trains")
        self.assertNotIn("same name", check().stdout)  # the same content
        with open(own / "trains" / part.name, "a") as copy:
            copy.write("# mine\n")
        self.assertIn("has the same name", check().stdout)


if __name__ == "__main__":
    rosunit.unitrun("train_brake", "several_launches", SeveralLaunches)
