#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Steps an FMU of one axis by co-simulation, as an importer does: run.py axis.fmu

Needs Python's own library only, and x86_64 Linux. The FMU is one of FMI 3.0:
hotfire export --fmu axis.fmu examples/c/axis.toml
"""

import ctypes
import sys
import tempfile
import xml.etree.ElementTree as xml
import zipfile
from pathlib import Path

PERIOD = 1e-3  # communication step [s]


@ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p)
def log(_, status, category, message):
    print(f"{category.decode()}: {message.decode()}", file=sys.stderr)


def main(fmu):
    with tempfile.TemporaryDirectory() as folder:
        zipfile.ZipFile(fmu).extractall(folder)
        description = xml.parse(Path(folder, "modelDescription.xml")).getroot()
        references = {variable.get("name"): int(variable.get("valueReference")) for variable in description.find("ModelVariables")}
        name = description.find("CoSimulation").get("modelIdentifier")
        library = ctypes.CDLL(str(Path(folder, f"binaries/x86_64-linux/{name}.so")))
        library.fmi3InstantiateCoSimulation.restype = ctypes.c_void_p

        def call(function, *arguments):
            status = getattr(library, function)(instance, *arguments)
            if status != 0:
                sys.exit(f"{function} returned {status}")

        def numbers(function, names, values):
            wanted = (ctypes.c_uint32 * len(names))(*(references[own] for own in names))
            given = (ctypes.c_double * len(names))(*values)
            call(function, wanted, ctypes.c_size_t(len(names)), given, ctypes.c_size_t(len(names)))
            return list(given)

        # Name, token, resources, visible, logging, event mode, early return, intermediate variables, environment, log, update.
        none = ctypes.c_void_p(None)
        instance = ctypes.c_void_p(
            library.fmi3InstantiateCoSimulation(
                b"axis", description.get("instantiationToken").encode(), f"{folder}/resources/".encode(), *[ctypes.c_bool(False)] * 4,
                none, ctypes.c_size_t(0), none, log, none,
            )
        )
        if not instance:
            sys.exit("the FMU makes no instance")
        call("fmi3EnterInitializationMode", ctypes.c_bool(False), ctypes.c_double(0.0), ctypes.c_double(0.0), ctypes.c_bool(False),
             ctypes.c_double(0.0))
        call("fmi3ExitInitializationMode")

        # A step of the command of 0.01 rad at 0.1 s.
        event, terminate, early, reached = ctypes.c_bool(), ctypes.c_bool(), ctypes.c_bool(), ctypes.c_double()
        for period in range(500):
            numbers("fmi3SetFloat64", ["command"], [0.01 if period >= 100 else 0.0])
            call("fmi3DoStep", ctypes.c_double(period * PERIOD), ctypes.c_double(PERIOD), ctypes.c_bool(True), ctypes.byref(event),
                 ctypes.byref(terminate), ctypes.byref(early), ctypes.byref(reached))
            if (period + 1) % 50 == 0:
                piston, engine = numbers("fmi3GetFloat64", ["piston", "engine"], [0.0, 0.0])
                print(f"{reached.value:.2f} s  piston {piston:+.5f} m  engine {engine:+.5f} rad")
        call("fmi3Terminate")
        library.fmi3FreeInstance(instance)


if __name__ == "__main__":
    main(*sys.argv[1:])
