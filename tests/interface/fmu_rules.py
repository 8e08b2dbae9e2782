#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks FMUs against the text of FMI 2.0.4 and FMI 3.0.2: fmu_rules.py FMU..., or fmu_rules.py --broken FMU...

Prints a line for every broken rule. Exit 1 if there is one. With --broken it breaks each rule in a copy of the description of
each FMU, and exits 1 if one of the copies passes.
"""
import copy
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
import zipfile

# Section 2.2 of 2.0 and 2.4 of 3.0: the elements of a description in their order, the attributes that they may have, and those
# that they must have (marked by !). Only what our FMUs use; anything else is reported.
BOOLEAN, NUMBER, WHOLE = r"true|false|0|1", r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", r"\d+"
TEXT, LINE, IDENTIFIER = r"(?s:.*)", r"[^\r\n\t]*", r"[A-Za-z_]\w*"
UNIT = {"BaseUnit": dict.fromkeys(["kg", "m", "s", "A", "K", "mol", "cd", "rad"], r"[-+]?\d+") | {"factor": NUMBER, "offset": NUMBER}}
COMMON = {
    "Unit": ({"name!": LINE}, ["BaseUnit"]),
    "BaseUnit": (UNIT["BaseUnit"], []),
    "UnitDefinitions": ({}, ["Unit"]),
    "LogCategories": ({}, ["Category"]),
    "Category": ({"name!": LINE, "description": TEXT}, []),
    "DefaultExperiment": ({"startTime": NUMBER, "stopTime": NUMBER, "tolerance": NUMBER, "stepSize": NUMBER}, []),
}
ROOT = {"fmiVersion!": "", "modelName!": TEXT, "description": TEXT, "author": TEXT, "version": LINE, "copyright": TEXT, "license": TEXT,
        "generationTool": LINE, "variableNamingConvention": "flat|structured"}
PARTS = ["CoSimulation", "UnitDefinitions", "TypeDefinitions", "LogCategories", "DefaultExperiment"]
NUMBERS = {"unit": LINE, "min": NUMBER, "max": NUMBER, "nominal": NUMBER, "start": NUMBER, "declaredType": LINE, "quantity": LINE}
VARIABLE = {"name!": LINE, "valueReference!": WHOLE, "description": TEXT,
            "causality": "parameter|calculatedParameter|input|output|local|independent|structuralParameter",
            "variability": "constant|fixed|tunable|discrete|continuous", "initial": "exact|approx|calculated"}
LIST = rf"({WHOLE}( {WHOLE})*)?"
ELEMENTS = {
    "2.0": COMMON | {
        "fmiModelDescription": (ROOT | {"fmiVersion!": r"2\.0", "guid!": LINE, "numberOfEventIndicators": WHOLE},
                                [*PARTS, "VendorAnnotations", "ModelVariables", "ModelStructure"]),
        "CoSimulation": ({"modelIdentifier!": IDENTIFIER} | dict.fromkeys(
            ["needsExecutionTool", "canHandleVariableCommunicationStepSize", "canInterpolateInputs", "canRunAsynchronuously",
             "canBeInstantiatedOnlyOncePerProcess", "canNotUseMemoryManagementFunctions", "canGetAndSetFMUstate",
             "canSerializeFMUstate", "providesDirectionalDerivative"], BOOLEAN) | {"maxOutputDerivativeOrder": WHOLE}, ["SourceFiles"]),
        "SourceFiles": ({}, ["File"]),
        "File": ({"name!": LINE}, []),
        "ModelVariables": ({}, ["ScalarVariable"]),
        "ScalarVariable": (VARIABLE, ["Real"]),
        "Real": (NUMBERS, []),
        "ModelStructure": ({}, ["Outputs", "Derivatives", "InitialUnknowns"]),
        "Outputs": ({}, ["Unknown"]),
        "InitialUnknowns": ({}, ["Unknown"]),
        "Unknown": ({"index!": WHOLE, "dependencies": LIST, "dependenciesKind": LINE}, []),
    },
    "3.0": COMMON | {
        "fmiModelDescription": (ROOT | {"fmiVersion!": r"3\.0", "instantiationToken!": LINE}, [*PARTS, "ModelVariables", "ModelStructure"]),
        "CoSimulation": ({"modelIdentifier!": IDENTIFIER} | dict.fromkeys(
            ["needsExecutionTool", "canBeInstantiatedOnlyOncePerProcess", "canGetAndSetFMUState", "canSerializeFMUState",
             "providesDirectionalDerivatives", "providesAdjointDerivatives", "providesPerElementDependencies",
             "canHandleVariableCommunicationStepSize", "providesIntermediateUpdate", "mightReturnEarlyFromDoStep",
             "canReturnEarlyAfterIntermediateUpdate", "hasEventMode", "providesEvaluateDiscreteStates"], BOOLEAN)
            | {"fixedInternalStepSize": NUMBER, "maxOutputDerivativeOrder": WHOLE}, []),
        "ModelVariables": ({}, ["Float64"]),
        "Float64": (VARIABLE | NUMBERS, []),
        "ModelStructure": ({}, ["Output", "InitialUnknown"]),
        "Output": ({"valueReference!": WHOLE, "dependencies": LIST, "dependenciesKind": LINE}, []),
        "InitialUnknown": ({"valueReference!": WHOLE, "dependencies": LIST, "dependenciesKind": LINE}, []),
        "fmiBuildDescription": ({"fmiVersion!": r"3\.0"}, ["BuildConfiguration"]),
        "BuildConfiguration": ({"modelIdentifier!": IDENTIFIER, "platform": LINE, "description": TEXT}, ["SourceFileSet", "Library"]),
        "SourceFileSet": ({"name": LINE, "language": LINE, "compiler": LINE, "compilerOptions": TEXT},
                          ["SourceFile", "PreprocessorDefinition", "IncludeDirectory"]),
        "SourceFile": ({"name!": LINE}, []),
        "PreprocessorDefinition": ({"name!": LINE, "optional": BOOLEAN, "value": LINE, "description": TEXT}, []),
        "IncludeDirectory": ({"name!": LINE}, []),
        "Library": ({"name!": LINE, "version": LINE, "external": BOOLEAN, "description": TEXT}, []),
    },
}
SEVERAL = {"Unit", "Category", "File", "ScalarVariable", "Float64", "Unknown", "Output", "InitialUnknown", "SourceFile", "Library",
           "PreprocessorDefinition", "IncludeDirectory", "SourceFileSet", "BuildConfiguration"}
NEEDED = {"fmiModelDescription": ["ModelVariables", "ModelStructure", "CoSimulation"], "UnitDefinitions": ["Unit"],
          "SourceFileSet": ["SourceFile"], "fmiBuildDescription": ["BuildConfiguration"]}
# Section 2.2.7 of 2.0 and 2.4.7.4 of 3.0: causality, variability and initial as they stand in the file.
ROLES = {("parameter", "fixed", "exact"), ("parameter", "tunable", "exact"), ("input", "continuous", None),
         ("output", "continuous", "calculated"), ("independent", "continuous", None)}
# The SI units of section 2.2.2 as exponents of kg, m, s, A and rad.
BASE_UNITS = ("kg", "m", "s", "A", "rad")
FACTORS = {"1": (0, 0, 0, 0, 0), "kg": (1, 0, 0, 0, 0), "m": (0, 1, 0, 0, 0), "s": (0, 0, 1, 0, 0), "A": (0, 0, 0, 1, 0),
           "rad": (0, 0, 0, 0, 1), "N": (1, 1, -2, 0, 0), "Pa": (1, -1, -2, 0, 0), "Hz": (0, 0, -1, 0, 0), "J": (1, 2, -2, 0, 0),
           "ohm": (1, 2, -3, -2, 0), "H": (1, 2, -2, -2, 0)}

# The functions that a binary exports: section 2.1 and 4.2 of 2.0 for co-simulation; appendix of 3.0, where an FMU has all.
TYPES_2 = ["Real", "Integer", "Boolean", "String"]
TYPES_3 = ["Float32", "Float64", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Boolean", "String", "Binary",
           "Clock"]
FUNCTIONS = {
    "2.0": {"fmi2" + name for name in """GetTypesPlatform GetVersion SetDebugLogging Instantiate FreeInstance SetupExperiment
        EnterInitializationMode ExitInitializationMode Terminate Reset GetFMUstate SetFMUstate FreeFMUstate SerializedFMUstateSize
        SerializeFMUstate DeSerializeFMUstate GetDirectionalDerivative SetRealInputDerivatives GetRealOutputDerivatives DoStep CancelStep
        GetStatus GetRealStatus GetIntegerStatus GetBooleanStatus GetStringStatus""".split()
            + [v + t for v in ("Get", "Set") for t in TYPES_2]},
    "3.0": {"fmi3" + name for name in """GetVersion SetDebugLogging InstantiateModelExchange InstantiateCoSimulation
        InstantiateScheduledExecution FreeInstance EnterInitializationMode ExitInitializationMode EnterEventMode Terminate Reset
        GetNumberOfVariableDependencies GetVariableDependencies GetFMUState SetFMUState FreeFMUState SerializedFMUStateSize
        SerializeFMUState DeserializeFMUState GetDirectionalDerivative GetAdjointDerivative EnterConfigurationMode ExitConfigurationMode
        GetIntervalDecimal GetIntervalFraction GetShiftDecimal GetShiftFraction SetIntervalDecimal SetIntervalFraction SetShiftDecimal
        SetShiftFraction EvaluateDiscreteStates UpdateDiscreteStates EnterContinuousTimeMode CompletedIntegratorStep SetTime
        SetContinuousStates GetContinuousStateDerivatives GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates
        GetNumberOfEventIndicators GetNumberOfContinuousStates EnterStepMode GetOutputDerivatives DoStep
        ActivateModelPartition""".split() + [v + t for v in ("Get", "Set") for t in TYPES_3]},
}
# Where the binary for this machine is.
BINARIES = {"2.0": "linux64", "3.0": "x86_64-linux"}
# Debian 12: the oldest system that the binary is for.
NEWEST_GLIBC = (2, 36)


def elements(root, version):
    """Elements and attributes are those of the schema, in its order."""
    attributes, children = ELEMENTS[version][root.tag]
    allowed = {name.rstrip("!"): pattern for name, pattern in attributes.items()}
    for name, value in root.attrib.items():
        if not re.fullmatch(allowed.get(name, "(?!)"), value):
            yield f"{root.tag}: attribute {name}={value!r} is not allowed"
    for name in attributes:
        if name.endswith("!") and name[:-1] not in root.attrib:
            yield f"{root.tag}: attribute {name[:-1]} is missing"
    last = 0
    for child in root:
        if child.tag not in children:
            yield f"{root.tag}: element {child.tag} is not allowed"
            continue
        place = children.index(child.tag)
        if place < last or (child.tag not in SEVERAL and sum(other.tag == child.tag for other in root) > 1):
            yield f"{root.tag}: element {child.tag} is out of order, or there is more than one"
        last = place
        yield from elements(child, version)
    for needed in NEEDED.get(root.tag, []):
        if root.find(needed) is None:
            yield f"{root.tag}: element {needed} is missing"


def variables_of(root):
    """The variables in their order, each as its attributes with those of its type."""
    return [dict(variable.attrib) | (dict(variable[0].attrib) if len(variable) else {}) for variable in root.find("ModelVariables")]


def names(root, version):
    """Names are unique, and so are value references; every variable says what it is."""
    seen = set()
    for variable in variables_of(root):
        for key in ("name", "valueReference"):
            if (key, variable[key]) in seen:
                yield f"{variable['name']}: {key}={variable[key]} is not unique"
            seen.add((key, variable[key]))
        if not variable.get("description"):
            yield f"{variable['name']}: the description is missing"


def roles(root, version):
    """Causality, variability and initial are one of the allowed combinations; one independent variable, named time, in s."""
    independent = []
    for variable in variables_of(root):
        role = tuple(variable.get(key) for key in ("causality", "variability", "initial"))
        if role not in ROLES:
            yield f"{variable['name']}: {role} is not an allowed combination"
        if role[0] == "independent":
            independent.append((variable["name"], variable.get("unit")))
    if independent != [("time", "s")]:
        yield f"the independent variables are {independent}; one is needed, time in s"


def starts(root, version):
    """A start value where the value is exact or an input, none where it is calculated; min <= start <= max."""
    for variable in variables_of(root):
        needed = variable.get("initial") == "exact" or variable.get("causality") == "input"
        if needed != ("start" in variable):
            yield f"{variable['name']}: a start value is {'missing' if needed else 'not allowed'}"
        low, high = float(variable.get("min", "-inf")), float(variable.get("max", "inf"))
        if not low <= float(variable.get("start", low if low > float("-inf") else min(high, 0.0))) <= high:
            yield f"{variable['name']}: start, min and max are out of order"


def units(root, version):
    """Every unit is defined once, and its base unit is what its factors say; of a mass the record defines them."""
    defined = {}
    for unit in root.findall("UnitDefinitions/Unit"):
        if unit.get("name") in defined:
            yield f"unit {unit.get('name')} is defined twice"
        defined[unit.get("name")] = unit.find("BaseUnit")
    for variable in variables_of(root):
        if variable.get("unit") is not None and variable["unit"] not in defined:
            yield f"{variable['name']}: unit {variable['unit']} is not defined"
        kinds = ("direct", "imposed_motion", "modal", "electromechanical")
        of_record = any("topology " + name in root.get("description") for name in kinds)
        if not of_record and (variable.get("unit") is None or defined.get(variable["unit"]) is None):
            yield f"{variable['name']}: a unit with a base unit is missing"
    for name, base in defined.items():
        factors = re.findall(r"(^|[./])([A-Za-z]+|1)(?:\^(-?\d+))?", name)
        if base is None or any(word not in FACTORS for _, word, _ in factors):
            continue
        expected = [sum((-1 if sign == "/" else 1) * int(power or 1) * FACTORS[word][i] for sign, word, power in factors)
                    for i in range(len(BASE_UNITS))]
        if [int(base.get(key, 0)) for key in BASE_UNITS] != expected:
            yield f"unit {name}: its base unit is not kg, m, s, rad to the powers {expected}"


def structure(root, version):
    """Exactly the outputs are listed, in their order, and exactly the calculated ones as initial unknowns, in their order."""
    variables = variables_of(root)
    references = [variable["valueReference"] for variable in variables]
    outputs = [variable["valueReference"] for variable in variables if variable.get("causality") == "output"]
    unknowns = [variable["valueReference"] for variable in variables if variable.get("initial") == "calculated"]
    lists = (("Output", outputs), ("InitialUnknown", unknowns))
    for tag, expected in lists:
        found = root.findall(f"ModelStructure/{tag}" if version == "3.0" else f"ModelStructure/{tag}s/Unknown")
        key = "valueReference" if version == "3.0" else "index"
        listed = [entry.get(key) if version == "3.0" else references[int(entry.get(key)) - 1] for entry in found]
        if listed != expected:
            yield f"{tag}: {listed} is not {expected}"
        for entry in found:
            if tag == "Output" and entry.get("dependencies") != "":
                yield f"{tag} {entry.get(key)}: an output depends on no input at the same point"


def capabilities(root, version):
    """The capabilities are those that the FMU has."""
    interface = root.find("CoSimulation")
    of_version = {"2.0": ["canGetAndSetFMUstate", "canSerializeFMUstate", "providesDirectionalDerivative",
                          "canNotUseMemoryManagementFunctions"],
                  "3.0": ["canGetAndSetFMUState", "canSerializeFMUState", "providesDirectionalDerivatives"]}[version]
    for name in ["canHandleVariableCommunicationStepSize", *of_version]:
        if interface.get(name) != "true":
            yield f"{name} is not true"
    step = root.find("DefaultExperiment").get("stepSize")
    if version == "3.0" and interface.get("fixedInternalStepSize") != step:
        yield "fixedInternalStepSize is not the step size of the experiment"


def archive(path, root, version):
    """The folders, names and compression of section 2.3 of 2.0 and 2.5 of 3.0; sources that are named are there."""
    identifier = root.find("CoSimulation").get("modelIdentifier")
    with zipfile.ZipFile(path) as file:
        entries = {entry.filename: entry for entry in file.infolist()}
        for name, entry in entries.items():
            if "\\" in name or entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) or entry.extract_version > 20:
                yield f"{name}: path or compression is not allowed"
            if entry.flag_bits & 0x9 or (entry.external_attr >> 28) == 0xA:
                yield f"{name}: encryption, a data descriptor or a link is not allowed"
            top = name.split("/")[0]
            if top not in ("modelDescription.xml", "documentation", "sources", "binaries", "resources"):
                yield f"{name}: a place that the standard does not name"
        sources = [entry.get("name") for entry in root.findall("CoSimulation/SourceFiles/File")]
        if version == "3.0":
            build = xml.fromstring(file.read("sources/buildDescription.xml"))
            yield from elements(build, version)
            if build.find("BuildConfiguration").get("modelIdentifier") != identifier:
                yield "buildDescription.xml: modelIdentifier is not that of modelDescription.xml"
            sources = [entry.get("name") for entry in build.iter("SourceFile")]
        if not sources:
            yield "no source file is named"
        for name in [f"binaries/{BINARIES[version]}/{identifier}.so", "documentation/index.html", "documentation/licenses/license.txt",
                     "documentation/externalDependencies.txt", "sources/CMakeLists.txt", *[f"sources/{source}" for source in sources]]:
            if name not in entries:
                yield f"{name} is missing"


def binary(data, version):
    """The binary exports the functions of the standard and nothing else, and needs the C library of Debian 12 and nothing else."""
    with tempfile.NamedTemporaryFile(suffix=".so") as file:
        file.write(data)
        file.flush()
        exported = subprocess.run(["nm", "-D", "--defined-only", file.name], capture_output=True, text=True, check=True).stdout
        needs = subprocess.run(["readelf", "--wide", "-d", "-V", file.name], capture_output=True, text=True, check=True).stdout
    found = {line.split()[-1].split("@")[0] for line in exported.splitlines()}
    for name in sorted(found ^ FUNCTIONS[version]):
        yield f"binary: {name} is {'not a function of the standard' if name in found else 'missing'}"
    for library in re.findall(r"\(NEEDED\).*\[(.*)\]", needs):
        if library not in ("libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2"):
            yield f"binary: needs {library}"
    versions = {tuple(map(int, number.split("."))) for number in re.findall(r"GLIBC_([\d.]+)", needs)}
    if not versions or max(versions) > NEWEST_GLIBC:
        yield f"binary: needs a C library of version {max(versions, default=None)}"


def binary_of(path, root, version):
    with zipfile.ZipFile(path) as file:
        return file.read(f"binaries/{BINARIES[version]}/{root.find('CoSimulation').get('modelIdentifier')}.so")


RULES = [elements, names, roles, starts, units, structure, capabilities]


def problems(root, version):
    for rule in RULES:
        try:
            yield from (f"{rule.__name__}: {problem}" for problem in rule(root, version))
        except (AttributeError, KeyError, IndexError, ValueError) as error:
            yield f"{rule.__name__}: the description cannot be read: {error!r}"


def value_of(variable):
    return variable[0] if len(variable) else variable


def swap(parent, i, j):
    parent[i], parent[j] = parent[j], parent[i]


def breaks(version):
    """What breaks a description, by the rule that must find it."""
    def pick(root, causality, i=0):
        return [v for v in root.find("ModelVariables") if v.get("causality") == causality][i]

    key = "valueReference" if version == "3.0" else "index"
    outputs = "ModelStructure" if version == "3.0" else "ModelStructure/Outputs"
    initial = "ModelStructure/InitialUnknown" if version == "3.0" else "ModelStructure/InitialUnknowns/Unknown"
    flag = "providesDirectionalDerivatives" if version == "3.0" else "providesDirectionalDerivative"
    return [
        ("elements", lambda r: swap(r, 1, 2)),
        ("elements", lambda r: r.set("kind", "own")),
        ("elements", lambda r: r.find("CoSimulation").attrib.pop("modelIdentifier")),
        ("elements", lambda r: r.find("CoSimulation").set("modelIdentifier", "1 axis")),
        ("elements", lambda r: r.remove(r.find("ModelStructure"))),
        ("elements", lambda r: value_of(pick(r, "parameter")).set("start", "about 3")),
        ("names", lambda r: pick(r, "output").set("name", pick(r, "input").get("name"))),
        ("names", lambda r: pick(r, "output").set("valueReference", pick(r, "input").get("valueReference"))),
        ("names", lambda r: pick(r, "output").attrib.pop("description")),
        ("roles", lambda r: pick(r, "parameter").set("variability", "continuous")),
        ("roles", lambda r: pick(r, "input").set("initial", "calculated")),
        ("roles", lambda r: r.find("ModelVariables").remove(pick(r, "independent"))),
        ("starts", lambda r: value_of(pick(r, "input")).attrib.pop("start")),
        ("starts", lambda r: value_of(pick(r, "output")).set("start", "0")),
        ("starts", lambda r: value_of(pick(r, "parameter")).set("min", "1e300")),
        ("units", lambda r: value_of(pick(r, "parameter")).set("unit", "furlong")),
        ("units", lambda r: r.find("UnitDefinitions/Unit[@name='s']/BaseUnit").set("s", "2")),
        ("structure", lambda r: r.find(outputs)[0].set(key, "1")),
        ("structure", lambda r: r.find(outputs)[0].set("dependencies", "1")),
        ("structure", lambda r: r.find(initial).set(key, "1")),
        ("capabilities", lambda r: r.find("CoSimulation").set(flag, "false")),
        ("capabilities", lambda r: r.find("CoSimulation").attrib.pop("canHandleVariableCommunicationStepSize")),
    ]


def main(words):
    failed = False
    broken = words[:1] == ["--broken"]
    for path in words[1:] if broken else words:
        with zipfile.ZipFile(path) as file:
            root = xml.fromstring(file.read("modelDescription.xml"))
        version = root.get("fmiVersion")
        if not broken:
            for problem in [*problems(root, version), *archive(path, root, version), *binary(binary_of(path, root, version), version)]:
                failed = True
                print(f"{path}: {problem}")
            continue
        for number, (rule, change) in enumerate(breaks(version)):
            changed = copy.deepcopy(root)
            change(changed)
            if not any(problem.startswith(f"{rule}: ") for problem in problems(changed, version)):
                failed = True
                print(f"{path}: break {number} of the rule {rule} was not found")
        of_version = b"fmi" + version[:1].encode()
        without_step = binary_of(path, root, version).replace(of_version + b"DoStep\0", of_version + b"DoStop\0")
        if len(list(binary(without_step, version))) != 2:
            failed = True
            print(f"{path}: a binary without DoStep was not found")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
