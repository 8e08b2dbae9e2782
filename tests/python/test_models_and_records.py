# SPDX-License-Identifier: Apache-2.0
"""Models and records: from files, from dictionaries and arrays, with the errors of the command."""

import numpy as np
import pytest
from conftest import FRICTION, command_line

import hotfire


def test_a_model_of_a_dictionary_is_the_model_of_the_file_with_these_keys(tmp_path):
    path = tmp_path / "bench.toml"
    path.write_text(hotfire.Model.text_of(FRICTION))
    assert hotfire.Model(path).text == hotfire.Model(FRICTION).text
    assert hotfire.Model.from_text(path.read_text()).text == hotfire.Model(FRICTION).text


def test_a_parameter_has_its_value_unit_bounds_and_meaning(model):
    torque = model.parameters["effects.gimbal_friction.coulomb_torque"]
    assert (torque.value, torque.unit, float(torque)) == (12e3, "N.m", 12e3)
    assert torque.least == 0.0 and torque.most > torque.value and "friction" in torque.meaning
    assert model["engine.inertia"] == 9490.0
    assert model.effects == {"effects.gimbal_friction": "lugre"}
    # `vibration_ratio` is of another law.
    assert "effects.gimbal_friction.vibration_ratio" not in model.parameters


def test_another_value_gives_another_model_and_leaves_the_first(model):
    heavier = model.with_values({"engine.inertia": 1e4, "effects.gimbal_friction.static_ratio": 1.5})
    assert heavier["engine.inertia"] == 1e4 and heavier["effects.gimbal_friction.static_ratio"] == 1.5
    assert model["engine.inertia"] == 9490.0
    with pytest.raises(hotfire.FileError, match=r"engine.inertia = -1.*outside its bounds; allowed: 1e-06 to 1e\+09 kg.m\^2"):
        model.with_values({"engine.inertia": -1.0})
    with pytest.raises(hotfire.FileError, match="outside its bounds"):
        model.with_values({"engine.inertia": np.nan})
    with pytest.raises(hotfire.UsageError, match='did you mean "engine.inertia"'):
        model.with_values({"engine.inertja": 1.0})


def test_several_axes_have_the_name_of_the_axis_before_the_key():
    taos = hotfire.Model({"topology": "taos", "engine": {"inertia": 9000.0}, "actuator": {"yaw": {"moment_arm": 0.8}}})
    assert taos["pitch.engine.inertia"] == 9000.0 and taos["yaw.actuator.moment_arm"] == 0.8
    assert taos.with_values({"yaw.engine.inertia": 9100.0})["yaw.engine.inertia"] == 9100.0


@pytest.mark.parametrize(
    "text",
    [
        'schema = 1\ntopology = "simplex"\n[engine]\ninertia = -3\n',
        'schema = 1\ntopology = "simplex"\n[engine]\ninertja = 3\n',
        'schema = 1\ntopology = "simplex"\n[engine]\ninertia = "3 m"\n',
        'schema = 1\ntopology = "simplex"\n[effects.gimbal_friction]\nlaw = "glue"\n',
        'schema = 1\ntopology = "simple"\n',
        "schema = \n",
    ],
)
def test_a_refused_model_is_an_exception_with_the_words_of_the_command(tmp_path, text):
    path = tmp_path / "wrong.toml"
    path.write_text(text)
    status, _, words = command_line("check", path)
    assert status == 6
    with pytest.raises(hotfire.FileError) as refused:
        hotfire.Model(path)
    assert str(refused.value) in words
    assert isinstance(refused.value, ValueError)


def test_a_record_of_a_file_is_that_of_the_command_and_goes_back_unchanged(tmp_path):
    path = tmp_path / "steps.csv"
    path.write_text("time[s],command[deg],piston[mm]\n0,0,1\n0.002,1,2\n0.004,1,3\n")
    record = hotfire.Record(path)
    assert list(record) == ["command", "piston"] and record.rows == 3 and record.period == 0.002
    assert record["piston"].unit == "m" and record["command"].unit == "rad"
    np.testing.assert_allclose(record["piston"].values, [1e-3, 2e-3, 3e-3], rtol=1e-15)
    np.testing.assert_allclose(record["command"].to("deg"), [0, 1, 1], rtol=1e-15)
    np.testing.assert_allclose(record.time, [0, 0.002, 0.004])
    record.save(tmp_path / "again.csv")
    again = hotfire.Record(tmp_path / "again.csv")
    assert all(np.array_equal(record[name].values, again[name].values) for name in record)
    with pytest.raises(hotfire.UnitError):
        record["piston"].to("s")


def test_an_array_with_a_unit_is_converted_and_the_values_outlive_the_record():
    values = hotfire.Record({"command": ([0.0, 1.0, 2.0], "deg")}, period=1e-3)["command"].values
    np.testing.assert_allclose(values, np.radians([0.0, 1.0, 2.0]), rtol=1e-15)
    with pytest.raises(ValueError):
        values[0] = 1.0


@pytest.mark.parametrize(
    "channels, period, words",
    [
        ({"comand": [0.0, 1.0]}, 1e-3, 'did you mean "command"'),
        ({"command": ([0.0, 1.0], "kg")}, 1e-3, "units that convert to rad"),
        ({"command": [0.0, np.nan]}, 1e-3, "command, row 1: nan is not a finite number"),
        ({"command": [0.0, 1.0], "piston": [0.0]}, 1e-3, "piston has 1 rows, command has 2"),
        ({"command": [[0.0, 1.0]]}, 1e-3, "2 dimensions"),
        ({"command": [0.0]}, 1e-3, "1 rows; allowed: 2 to"),
        ({"command": [0.0, 1.0]}, 1.0, "a rate of 50 Hz to 20000 Hz"),
        ({"command": [0.0, 1.0]}, 0.0, "a rate of 50 Hz to 20000 Hz"),
    ],
)
def test_arrays_that_are_no_record_are_refused(channels, period, words):
    with pytest.raises(hotfire.FileError, match=words.replace("(", r"\(")):
        hotfire.Record(channels, period=period)


def in_words_of_the_stub(annotation: str) -> str:
    """A type as pybind11 prints it, in the words of the stub."""
    for printed, word in (("hotfire._core.", ""), ("numpy.ndarray[numpy.float64]", "npt.NDArray[np.float64]"),
                          ("os.PathLike", "str | os.PathLike[str]"), ("List[", "list["), ("Tuple[", "tuple["),
                          ("Dict[", "dict[")):
        annotation = annotation.replace(printed, word)
    return annotation


def disagreements_of_the_stub(stub_text: str) -> list:
    """Where the stub says another name, argument, order or type than the compiled part."""
    import ast
    import re

    from hotfire import _core

    found = []

    def compare(where, node, compiled):
        signature = (compiled.fget if isinstance(compiled, property) else compiled).__doc__.splitlines()[0]
        printed = ast.parse(f"def {re.sub('^[a-z_]*', 'f', signature)}: ...").body[0]
        declared = [*node.args.posonlyargs, *node.args.args]
        if [each.arg for each in declared] != ["self"] * ("self" in signature) + [
            each.arg for each in printed.args.args if each.arg != "self"
        ] and not isinstance(compiled, property):
            # An argument without a name is printed as arg0: the stub then allows it by its position alone.
            nameless = [each.arg.startswith("arg") for each in printed.args.args if each.arg != "self"]
            of_position = [each in node.args.posonlyargs for each in declared if each.arg != "self"]
            if not (any(nameless) and nameless == of_position):
                found.append(f"{where}: arguments {[each.arg for each in declared]}, compiled: {signature}")
        types = [(each.annotation, other.annotation) for each, other in zip(declared, printed.args.args) if each.annotation]
        for mine, other in [*types, (node.returns, printed.returns)]:
            wanted = in_words_of_the_stub(ast.unparse(other))
            said = ast.unparse(mine).replace("Sequence[", "list[")
            # Python objects that the compiled part takes and gives as they are.
            if wanted not in (said, "object", "tuple", "dict", "list", "numpy.ndarray") and not wanted.startswith("Callable"):
                found.append(f"{where}: {said}, compiled: {wanted}")

    stub = ast.parse(stub_text)
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    functions = {node.name: node for node in stub.body if isinstance(node, ast.FunctionDef)}
    here = {name for name in dir(_core) if not name.startswith("_")}
    found += [f"{name}: in one of the two only" for name in here ^ {*classes, *functions, "version"}]
    for name in here & set(functions):
        compare(name, functions[name], getattr(_core, name))
    for name in ("Model", "Record"):
        members = {node.name: node for node in classes[name].body if isinstance(node, ast.FunctionDef)}
        of_class = {member for member in vars(getattr(_core, name)) if not member.startswith("_")}
        found += [f"{name}.{member}: in one of the two only" for member in of_class ^ (set(members) - {"__len__"})]
        for member in of_class & set(members):
            compare(f"{name}.{member}", members[member], getattr(getattr(_core, name), member))
    return found


def test_the_stub_says_the_names_arguments_and_types_of_the_compiled_part():
    from pathlib import Path

    text = (Path(hotfire.__file__).parent / "_core.pyi").read_text()
    assert disagreements_of_the_stub(text) == []
    # Each wrong word is found.
    for right, wrong in (("fit_start: int", "first_rows: int"), ("seed: int", "seed: float"), ("def sha256", "def sha512"),
                         ("-> list[str]", "-> list[int]"), ("def period", "def step"), ("-> float", "-> int")):
        assert right in text
        assert disagreements_of_the_stub(text.replace(right, wrong, 1)) != [], wrong
