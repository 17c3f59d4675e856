#!/usr/bin/python3
"""Draws the figures of docs/guide from runs made for them, into docs/guide/figures. The workspace is sourced.

usage: tools/guide_figures.py
"""
import pathlib
import shutil
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
FIGURES = ROOT / "docs" / "guide" / "figures"
EMERGENCY = str(ROOT / "config" / "scenarios" / "emergency.yaml")
STAND = ["--set", "duration_s=90", "--set", "until.standing=true", "--set", "record_interval_s=0.1"]


def call(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)


def main():
    FIGURES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        here = pathlib.Path(name)
        call("train_sim", "run", EMERGENCY, "--model", "ltd", *STAND, "--out", here / "stand")
        call(
            "train_sim",
            "run",
            EMERGENCY,
            "--model",
            "ltd",
            *STAND,
            "--set",
            "initial_speed_kmh=60",
            "--out",
            here / "slower"
        )
        call(
            "rosrun",
            "train_brake",
            "report",
            here / "stand",
            here / "slower",
            "--out",
            here / "c.html",
            "--figures",
            here / "f",
        )
        shutil.copy(here / "f" / "speeds.png", FIGURES / "compared_speeds.png")
        shutil.copy(here / "f" / "largest_coupler_forces.png", FIGURES / "compared_forces.png")
        call(
            "rosrun",
            "train_brake",
            "sweep",
            EMERGENCY,
            here / "nine",
            "--model",
            "ltd",
            "--set",
            "duration_s=20",
            "--figures",
            "--grid",
            "initial_speed_kmh=40:80:3",
            "--grid",
            "train.connection.draft_gear.slack_m=0,0.01,0.02",
        )
        shutil.copy(here / "nine" / "figures" / "max_tension_n_value_over_initial_speed_kmh.png", FIGURES / "study.png")


if __name__ == "__main__":
    main()
