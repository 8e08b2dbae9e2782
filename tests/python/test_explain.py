# SPDX-License-Identifier: Apache-2.0
"""The finder gives the report of the command, shows progress and can be stopped."""

import json
import os
import signal
import threading

import numpy as np
import pytest
from conftest import command_line

import hotfire


@pytest.fixture(scope="module")
def inputs(case):
    return hotfire.Model(case / "declared.toml"), hotfire.Record(case / "steps.csv")


@pytest.fixture(scope="module")
def found(inputs):
    model, record = inputs
    said = []
    return hotfire.explain(model, record, most_effects=1, progress=said.append), said


def without_times(report):
    report = json.loads(json.dumps(report))
    for key in ("date", "command_line", "seconds"):
        del report[key]
    for row in report["search"]:
        del row["seconds"]
    return report


def test_the_report_is_that_of_the_command(case, found, tmp_path):
    explanation, said = found
    status, _, words = command_line(
        "explain", "--model", case / "declared.toml", "--out", tmp_path, "--most-effects", "1", case / "steps.csv"
    )
    assert status == 0, words
    of_command = json.loads((tmp_path / "report.json").read_text())
    assert without_times(explanation.report) == without_times(of_command)
    assert explanation.model.text == (tmp_path / "explained.toml").read_text()
    assert len(said) > 3 and all(isinstance(line, str) for line in said)
    explanation.save(tmp_path / "python")
    assert without_times(json.loads((tmp_path / "python/report.json").read_text())) == without_times(of_command)


def test_the_report_of_a_mass_is_that_of_the_command(tmp_path):
    mass = {"inertia": 2.0, "damping": 3.0, "stiffness": 100.0}
    seconds = np.arange(6000) * 5e-3
    force = ("N", 8.0 * np.sin(1.3 * seconds) + 6.0 * np.sin(2.9 * seconds + 1.0) + 5.0 * np.sin(7.1 * seconds + 2.0))
    true = hotfire.Model({"topology": "direct", "mass": mass, "effects": {"cubic_stiffness": {"stiffness": 900.0}}})
    driven = hotfire.Record({"force": force[::-1], "position": (0.0 * seconds, "m")}, period=5e-3)
    position = hotfire.simulate(true, driven)["position"].values + np.random.default_rng(5).normal(0.0, 2e-4, seconds.size)
    hotfire.Record({"force": force[::-1], "position": (position, "m")}, period=5e-3).save(tmp_path / "mass.csv")
    hotfire.Model({"topology": "direct", "mass": mass}).save(tmp_path / "declared.toml")
    explanation = hotfire.explain(hotfire.Model(tmp_path / "declared.toml"), hotfire.Record(tmp_path / "mass.csv"))
    assert [effect.name for effect in explanation.effects] == ["cubic_stiffness"]
    status, _, words = command_line(
        "explain", "--model", tmp_path / "declared.toml", "--out", tmp_path / "found", tmp_path / "mass.csv"
    )
    assert status == 0, words
    assert without_times(explanation.report) == without_times(json.loads((tmp_path / "found/report.json").read_text()))


def test_results_are_objects_with_units(found):
    explanation, _ = found
    effect = explanation.effects[0]
    assert effect.name == "gimbal_friction" and effect.site == "engine_torque"
    torque = effect.parameters["coulomb_torque"]
    assert torque.unit == "N.m" and torque.identified and torque.ci95[0] <= torque.value <= torque.ci95[1]
    engine = explanation.channels["engine"]
    assert engine.unit == "rad" and engine.after.rms < engine.before.rms
    assert all(value.unit for value in explanation.calibration.values())


def test_a_notebook_shows_the_report_page(found):
    explanation, _ = found
    shown = explanation._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "gimbal_friction" in shown
    # The page is an attribute: a quote of its own would end it.
    assert shown.count('"') == 6


def test_ctrl_c_ends_the_search_with_what_is_known_so_far(inputs):
    model, record = inputs

    def interrupt(_):
        if not sent:
            sent.append(True)
            os.kill(os.getpid(), signal.SIGINT)

    sent = []
    with pytest.raises(KeyboardInterrupt) as stopped:
        hotfire.explain(model, record, progress=interrupt)
    assert isinstance(stopped.value, hotfire.Interrupted)
    assert stopped.value.explanation.verdict == "undecided"
    assert "engine" in stopped.value.explanation.channels


def test_an_exception_of_the_callback_ends_the_search_and_is_raised(inputs):
    model, record = inputs

    def fail(what):
        raise RuntimeError("not this: " + what)

    with pytest.raises(RuntimeError, match="not this"):
        hotfire.explain(model, record, progress=fail)


def test_explain_runs_beside_other_threads(inputs):
    model, record = inputs
    results = []
    thread = threading.Thread(target=lambda: results.append(hotfire.explain(model, record, most_effects=0, threads=1)))
    thread.start()
    thread.join()
    assert results[0].effects == []


def test_what_cannot_be_explained_is_refused_in_the_words_of_the_command(inputs):
    model, _ = inputs
    with pytest.raises(hotfire.FileError, match="command"):
        hotfire.explain(model, hotfire.Record({"piston": [0.0] * 1000}, period=1e-3))
    with pytest.raises(hotfire.UsageError, match="most_effects = 9; allowed: 0 to 8"):
        hotfire.explain(model, [], most_effects=9)
