"""For catkin_python_setup() only."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(
    **generate_distutils_setup(
        packages=["train_brake", "train_brake_report", "train_brake_report.figures"],
        package_dir={"": "src"},
        package_data={"train_brake_report": ["page.html"]},
    )
)
