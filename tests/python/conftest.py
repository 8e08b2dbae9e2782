# SPDX-License-Identifier: Apache-2.0
"""What the tests share: the command, a model, a record, and a case with a missing effect."""

import os
import subprocess
import tarfile
from pathlib import Path

import numpy as np
import pytest

import hotfire

PROGRAM = os.environ["HOTFIRE_PROGRAM"]
SOURCE = Path(os.environ["HOTFIRE_SOURCE"])

FRICTION = {
    "name": "bench",
    "topology": "simplex",
    "engine": {"inertia": "9490 kg.m^2"},
    "effects": {"gimbal_friction": {"law": "lugre", "coulomb_torque": "12 kN.m", "static_ratio": 1.2}},
}


def command_line(*words):
    """Runs `hotfire` and returns what it printed; the words of an error on the other hand."""
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


@pytest.fixture
def model():
    return hotfire.Model(FRICTION)


@pytest.fixture
def record():
    time = np.arange(4000) * 1e-3
    return hotfire.Record({"command": 0.02 * np.sin(6.0 * time) + 0.01 * (time > 2.0)}, period=1e-3)


@pytest.fixture(scope="session")
def case(tmp_path_factory):
    """The folder of the case `friction`: declared.toml and records."""
    folder = tmp_path_factory.mktemp("case")
    with tarfile.open(SOURCE / "tests/data/challenge/friction.tar.xz") as archive:
        archive.extractall(folder)
    return folder / "friction" / "given"
