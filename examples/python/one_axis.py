#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# One axis from a declared model to its missing effect. Run it as a script, or cell by cell in an editor that knows
# `# %%`: python3 one_axis.py [FOLDER]; pictures and the report go to FOLDER.

# %%
import sys
from pathlib import Path

import numpy as np

import hotfire

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "one_axis")
folder.mkdir(parents=True, exist_ok=True)

# %% A declared model, and a rig that has friction in its gimbal besides
declared = hotfire.Model({"name": "bench", "topology": "simplex", "tolerance": {"engine": {"inertia": 0.03}}})
rig = hotfire.Model(
    {
        "topology": "simplex",
        "effects": {"gimbal_friction": {"law": "coulomb", "coulomb_torque": "15 kN.m"}},
    }
)
print(declared, rig, sep="\n")

# %% A test of 16 s, and what the rig's sensors read
time = np.arange(4000) * 4e-3
command = np.where(time < 8.0, 0.01 * np.sin(2.0 * time), 0.01 * np.sign(np.sin(1.5 * time)))
truth = hotfire.simulate(rig, command, period=4e-3)
noise = np.random.default_rng(1)
measured = hotfire.Record(
    {
        "command": command,
        "piston": truth["piston"].values + 8e-6 * noise.standard_normal(len(time)),
        "engine": truth["engine"].values + 1e-5 * noise.standard_normal(len(time)),
    },
    period=4e-3,
    name="test",
)

# %% How far the declared model is off
run = hotfire.simulate(declared, measured)
off = run["engine"].to("deg") - measured["engine"].to("deg")
print(f"the declared model is off by {np.std(off):.2g} deg rms")

# %% Which parameter would change what
slopes = hotfire.gradients(declared, measured, ["engine.inertia", "engine.viscous_damping"])
for key, column, unit in zip(slopes.keys, slopes["engine"].T, slopes.units["engine"]):
    print(f"{key}: {np.std(column):.2g} {unit} rms")

# %% A family of models, on all cores
inertias = [8500.0, 9000.0, 9500.0, 10000.0]
family = hotfire.simulate_many([declared.with_values({"engine.inertia": value}) for value in inertias], measured)
for value, own in zip(inertias, family):
    error = np.std(own["engine"].values - measured["engine"].values)
    print(f"inertia {value:g} kg.m^2: off by {np.degrees(error):.2g} deg rms")

# %% What is missing in the model
found = hotfire.explain(declared, measured, most_effects=1, progress=lambda what: print(" ", what, file=sys.stderr))
print(found)
for effect in found.effects:
    for name, value in effect.parameters.items():
        print(f"  {effect.name}.{name} = {value.value:.4g} {value.unit}, 95 % {value.ci95}")
found.save(folder)

# %% In a notebook `found` alone shows the report page; a picture where matplotlib is installed
try:
    hotfire.plot.record(measured, ["engine"], beside=hotfire.simulate(found.model, measured)).savefig(folder / "engine.png")
except ImportError as missing:
    print(missing)
assert [effect.name for effect in found.effects] == ["gimbal_friction"]
