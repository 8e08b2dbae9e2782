# SPDX-License-Identifier: Apache-2.0
"""Simulation has the bits of the command, batches those of single runs, gradients those of differences."""

import sys
import threading
import time

import numpy as np
import pytest
from conftest import FRICTION, command_line

import hotfire

AXES = {"taos": ["pitch", "yaw"], "masv": [f"{axis}{engine}" for engine in range(1, 5) for axis in ("pitch", "yaw")]}


def inputs_of(topology):
    seconds = np.arange(1000) * 1e-3
    if topology == "direct":
        return hotfire.Record({"force": (20.0 * np.sin(9.0 * seconds), "N"), "position": (0.0 * seconds, "m")}, period=1e-3)
    if topology == "simplex":
        return hotfire.Record({"command": 0.02 * np.sin(9.0 * seconds)}, period=1e-3)
    return hotfire.Record(
        {f"command.{axis}": 0.02 * np.sin((5.0 + i) * seconds) for i, axis in enumerate(AXES[topology])}, period=1e-3
    )


def model_of(topology):
    if topology == "direct":
        return hotfire.Model({"topology": "direct", "mass": {"inertia": 2.0, "damping": 3.0, "stiffness": 100.0}})
    if topology == "simplex":
        return hotfire.Model(FRICTION)
    return hotfire.Model({"topology": topology})


@pytest.mark.parametrize("topology", ["direct", "simplex", "taos", "masv"])
def test_a_simulation_has_the_bits_of_the_command(tmp_path, topology):
    model, inputs = model_of(topology), inputs_of(topology)
    model.save(tmp_path / "m.toml")
    inputs.save(tmp_path / "in.csv")
    status, _, words = command_line(
        "simulate", "--model", tmp_path / "m.toml", "--input", tmp_path / "in.csv", "--output", tmp_path / "out.csv"
    )
    assert status == 0, words
    expected = hotfire.Record(tmp_path / "out.csv")
    found = hotfire.simulate(model, hotfire.Record(tmp_path / "in.csv"))
    assert list(found) == list(expected)
    for name in expected:
        assert found[name].unit == expected[name].unit
        assert np.array_equal(found[name].values, expected[name].values), name


def test_an_array_is_the_command_of_one_axis(model, record):
    of_array = hotfire.simulate(model, np.array(record["command"]), period=1e-3)
    assert np.array_equal(of_array["engine"], hotfire.simulate(model, record)["engine"])
    with pytest.raises(hotfire.UsageError, match="the command of one axis"):
        hotfire.simulate(hotfire.Model({"topology": "taos"}), np.zeros(100), period=1e-3)


def test_a_record_without_the_input_is_refused_in_the_words_of_the_command(model):
    with pytest.raises(hotfire.FileError, match="no column command: the model is driven by it; the record has piston"):
        hotfire.simulate(model, hotfire.Record({"piston": np.zeros(100)}, period=1e-3))


def test_a_batch_has_the_bits_of_single_runs_in_their_order(model, record):
    models = [model.with_values({"engine.inertia": value}) for value in (8e3, 9e3, 1e4, 1.1e4, 1.2e4)]
    batch = hotfire.simulate_many(models, record, threads=3)
    for own, expected in zip(batch, models):
        assert np.array_equal(own["engine"], hotfire.simulate(expected, record)["engine"])
    assert not np.array_equal(batch[0]["engine"], batch[1]["engine"])
    assert hotfire.simulate_many([], record) == []
    with pytest.raises(hotfire.UsageError, match="5 models and 2 records"):
        hotfire.simulate_many(models, [record, record])
    with pytest.raises(hotfire.FileError, match="no column command"):
        hotfire.simulate_many(models, hotfire.Record({"piston": np.zeros(100)}, period=1e-3))


@pytest.mark.parametrize("threads", [1, 3])
def test_a_batch_of_unlike_models_has_the_bits_of_single_runs_in_their_order(model, record, threads):
    stiff = model.with_values({"actuator.leakage": 1e-11})
    models = []
    for i in range(11):
        models += [(model if i % 2 else stiff).with_values({"engine.inertia": 8e3 + 100.0 * i}), model_of("simplex")]
    inputs = [record] * len(models)
    models.insert(5, model_of("taos"))
    inputs.insert(5, inputs_of("taos"))
    batch = hotfire.simulate_many(models, inputs, threads=threads)
    assert len(batch) == len(models)
    for own, expected, driven_by in zip(batch, models, inputs):
        alone = hotfire.simulate(expected, driven_by)
        assert list(own) == list(alone)
        for name in alone:
            assert np.array_equal(own[name].values, alone[name].values), name


def test_the_first_run_that_fails_is_what_a_batch_fails_with(model, record):
    unstable = [model.with_values({"servovalve.position_gain": gain}) for gain in (9e5, 8e5)]
    alone = []
    for own in unstable:
        with pytest.raises(hotfire.FileError, match="runs away") as failure:
            hotfire.simulate(own, record)
        alone.append(str(failure.value))
    models = [model, model.with_values({"engine.inertia": 9e3}), *unstable, model.with_values({"engine.inertia": 1e4})]
    with pytest.raises(hotfire.FileError) as failure:
        hotfire.simulate_many(models, record, threads=1)
    assert str(failure.value) == alone[0]


def test_other_threads_of_python_go_on_while_a_model_runs(model):
    # A thread that counts every millisecond gets nowhere while another holds the lock of the interpreter.
    ticks = []
    stop = threading.Event()

    def count():
        while not stop.wait(0.001):
            ticks.append(time.monotonic())

    inputs = hotfire.Record({"command": np.zeros(400_000)}, period=1e-3)
    counter = threading.Thread(target=count)
    counter.start()
    began = time.monotonic()
    hotfire.simulate(model, inputs)
    ended = time.monotonic()
    stop.set()
    counter.join()
    assert sum(began < tick < ended for tick in ticks) >= 3


def test_a_gradient_is_the_limit_of_differences():
    model = hotfire.Model({"topology": "simplex"})
    inputs = inputs_of("simplex")
    keys = ["engine.inertia", "servovalve.position_gain", "actuator.moment_arm", "structure.stiffness", "engine.duct_stiffness"]
    slopes = hotfire.gradients(model, inputs, keys)
    assert slopes["engine"].shape == (inputs.rows, len(keys))
    assert slopes.units["engine"][0] == "rad/(kg.m^2)"
    for column, key in enumerate(keys):
        # Central differences are wrong by the square of the step, 1e-8, and by rounding, 1e-12 over it.
        step = 1e-4 * model[key]
        more, less = (hotfire.simulate(model.with_values({key: model[key] + side * step}), inputs) for side in (1, -1))
        for channel in ("piston", "engine"):
            difference = (more[channel].values - less[channel].values) / (2.0 * step)
            error = slopes[channel][:, column] - difference
            assert np.std(error) < 1e-5 * np.std(difference), (key, channel)


def test_a_gradient_of_a_mass_has_the_position_of_the_record_in_its_unit():
    model = hotfire.Model({"topology": "direct", "mass": {"inertia": 2.0, "damping": 3.0, "stiffness": 100.0}})
    slopes = hotfire.gradients(model, inputs_of("direct"), ["mass.stiffness"])
    assert slopes.units["position"] == ("position/(force/position)",)


def test_gradients_are_by_all_that_acts_by_default(model, record):
    assert set(hotfire.gradients(model, record).keys) == set(model.parameters)
    with pytest.raises(hotfire.UsageError, match="not a parameter that acts"):
        hotfire.gradients(model, record, ["effects.backlash.half_width"])
    with pytest.raises(hotfire.UsageError, match='not a parameter that acts in the model; did you mean "pitch.engine.inertia"'):
        hotfire.gradients(hotfire.Model({"topology": "taos"}), inputs_of("taos"), ["pitch.engine.inertja"])


# Under a misaligned thrust a run depends on what the record has for it.
GIMBAL = {"gimbal": {"thrust": "1.86 MN", "pitch_misalignment": "10 mm"}}
STRINGS = {"strings": {"lag": "2 ms"}, "sensors": {"piston": {"lag": "1 ms"}}}
NOISE = {"strings": {"lag": "2 ms", "noise": "20 um"}, "sensors": {"piston": {"lag": "1 ms", "noise": "10 um", "step": "5 um"}}}


@pytest.mark.parametrize(
    "topology, still, noisy, thrust, keys",
    [
        ("taos", STRINGS, NOISE, "thrust", ["pitch.engine.inertia", "yaw.servovalve.position_gain", "pitch.structure.stiffness"]),
        ("masv", {}, {}, "thrust.engine1", ["pitch1.engine.inertia", "yaw4.servovalve.position_gain"]),
    ],
)
def test_a_gradient_of_several_axes_is_the_limit_of_differences(topology, still, noisy, thrust, keys):
    still, noisy = (hotfire.Model({"topology": topology, **GIMBAL, **parts}) for parts in (still, noisy))
    first = AXES[topology][0]
    rows = np.arange(400)
    channels = {name: channel.values[rows] for name, channel in inputs_of(topology).items()}
    # A torque is interpolated between rows, a thrust is held.
    channels[f"torque.{first}"] = 5e3 * np.sin(0.5 * rows)
    channels[thrust] = 1.8e6 + 1e5 * np.sin(0.5 * rows)
    record = hotfire.Record(channels, period=1e-3)
    slopes = hotfire.gradients(noisy, record, keys)
    assert slopes.units[f"engine.{first}"][0] == "rad/(kg.m^2)"
    assert set(slopes.slopes) == {name for name in hotfire.simulate(noisy, record) if not name.startswith("command")}
    for column, key in enumerate(keys):
        # Noise and steps of a reading have no slope.
        step = 1e-4 * still[key]
        more, less = (hotfire.simulate(still.with_values({key: still[key] + side * step}), record) for side in (1, -1))
        for channel, found in slopes.slopes.items():
            difference = (more[channel].values - less[channel].values) / (2.0 * step)
            # A string's reading is a small difference of lengths of metres.
            rounding = 1e-15 * max(1.0, np.max(np.abs(more[channel].values))) / step
            assert np.std(found[:, column] - difference) < 1e-5 * np.std(difference) + rounding, (key, channel)
        assert np.std(slopes["engine." + key.partition(".")[0]][:, column]) > 0.0
    alone = hotfire.gradients(noisy, record, keys[:1], threads=1)
    assert np.array_equal(alone[f"engine.{first}"][:, 0], slopes[f"engine.{first}"][:, 0])


def test_the_gradient_of_an_engine_that_rests_is_a_number():
    friction = {"thrust": "1.86 MN", "friction": {"law": "lugre", "coulomb_torque": "20 kN.m"}}
    model = hotfire.Model({"topology": "masv", "gimbal": friction})
    record = hotfire.Record({"command.pitch1": 0.01 * np.sin(0.02 * np.arange(200))}, period=1e-3)
    slopes = hotfire.gradients(model, record, ["pitch1.engine.inertia", "yaw3.engine.inertia"])
    assert all(np.all(np.isfinite(values)) for values in slopes.slopes.values())
    assert np.std(slopes["engine.pitch1"][:, 0]) > 0.0


def test_a_sweep_has_the_notch_of_the_command(tmp_path, model):
    import json

    model.save(tmp_path / "m.toml")
    status, printed, words = command_line(
        "sweep", "--model", tmp_path / "m.toml", "--profile", "sines", "--amplitudes", "0.4", "--from", "6", "--to", "9",
        "--count", "5", "--coarse", "--json",
    )
    assert status == 0, words
    expected = json.loads(printed)
    found = hotfire.sweep(model, amplitudes=[np.radians(0.4)], frequencies=(6.0, 9.0), count=5, coarse=True)
    assert [own.channel for own in found] == [own["channel"] for own in expected]
    for own, of_command in zip(found, expected):
        # The command reads degrees, and pi / 180 rounds.
        np.testing.assert_allclose(own.gain, [point["gain_decibels"] for point in of_command["response"]], rtol=1e-9)
        assert (own.notch is None) == (of_command["notch"] is None)
    again = hotfire.analyse_sweep(found[0].record, moment_arm=model["actuator.moment_arm"])
    np.testing.assert_array_equal(again[0].gain, found[0].gain)


def test_pictures_have_a_line_for_each_channel(model, record):
    pytest.importorskip("matplotlib")
    run = hotfire.simulate(model, record)
    figure = hotfire.plot.record(run, ["engine", "piston"], beside=run)
    assert [len(axes.lines) for axes in figure.axes] == [2, 2]
    assert figure.axes[0].get_ylabel() == "engine [rad]"
    swept = hotfire.sweep(model, frequencies=(6.0, 9.0), count=3, coarse=True)
    assert len(hotfire.plot.sweep(swept).axes[0].lines) == len(swept)


def test_without_matplotlib_a_picture_says_what_to_install_and_all_else_works(monkeypatch, model, record):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.delitem(sys.modules, "matplotlib.pyplot", raising=False)
    run = hotfire.simulate(model, record)
    with pytest.raises(ImportError, match="apt-get install python3-matplotlib"):
        hotfire.plot.record(run, ["engine"])
