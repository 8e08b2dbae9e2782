# SPDX-License-Identifier: Apache-2.0
# The arrows between the folders and between the rooms inside the larger ones. Checked by layering.cmake; drawn into
# docs/architecture.md and docs/architecture/inner-folders.md by draw_rooms.cmake.

# What a file of a folder may include of ours, by its path from the root.
set(rooms model hal firmware tools tests)
set(allowed_model model)
set(allowed_hal hal)
set(allowed_firmware firmware model hal)
set(allowed_tools tools model hal/arithmetic hal/sim hal/recording hal/live hal/schedule)
# What other programs call is compiled on any target, and knows nothing of the host side.
set(allowed_interface tools/interface model hal/arithmetic firmware/image)
set(allowed_tests tests tools firmware model hal)

# The rooms inside the larger folders: what each one is for, and below each room the rooms of the same folder that its files
# may include. A file beside the rooms may include all of them; no room includes a file beside the rooms.
set(houses model model/effects firmware tools/explain tools/files tools/study tools/interface tools/cli tests/model)

# room(HOUSE NAME "what it is for" ROOM_BELOW...): rooms are declared from the lowest up.
macro(room house name purpose)
  list(APPEND rooms_of_${house} ${name})
  set(below_${house}/${name} ${ARGN})
  set(purpose_of_${house}/${name} "${purpose}")
endmacro()

room(model numerics "scalars, exact steps of linear systems, delay lines, memories, roots, interpolation; nothing about actuators")
room(model declaration "how an effect declares itself: fields, sites, the list of effects" numerics)
room(model friction "friction laws: Coulomb, Stribeck, Dahl, LuGre, in one direction and in two" declaration numerics)
room(model structure "structural modes, of a vehicle and of a rig" declaration numerics)
room(model actuator "one hydraulic axis: its parameters, its states, its step; the parts of a motor's actuator" declaration numerics)
room(model engine "the engine on its gimbal: attach points, moment arms, the bearing and its block" friction structure declaration numerics)
room(model effects "the effects, one file each" actuator friction structure declaration numerics)
room(model sensors "string potentiometers and what else reads a vehicle" effects engine declaration numerics)

room(model/effects command "effects on the command of the axis: scale, rate limit, delay")
room(model/effects valve "effects in the servovalve: bias, hysteresis, dead band, asymmetry")
room(model/effects actuator "effects in the cylinder: leakage, friction of the piston")
room(model/effects load "effects between piston and engine: play, soft stiffness, moment arm, a structural mode")
room(model/effects gimbal "torques on the engine: friction of the bearing, ducts, offset, the other axis")
room(model/effects mass "forces on a mass or in a joint (`direct`, `electromechanical`, `imposed_motion`, `modal`)")
room(model/effects sensor "effects in a sensor: scale, nonlinearity, lag, delay")
room(model/effects unlisted "terms of unknown law: the grammar, tables, short laws" command)

room(tools/explain policy "the constants by which the finder decides")
room(tools/explain words "every sentence of the report and every refusal, from names and numbers")
room(tools/explain data "records as the finder uses them: rows to fit, to hold out, to exclude; noise; start states" words)
room(tools/explain fit "simulation error, gradients and the least-squares fit" data words policy)
room(tools/explain vehicle "a vehicle as axes, each beside the motion of the others" fit data words policy)
room(tools/explain inference "confidence intervals, identifiability, the veto, and faults of a channel" fit data words policy)
room(tools/explain latent "an unknown signal at each place: where the missing term acts" fit data words policy)
room(tools/explain terms "candidates: listed effects, and terms of unknown law with their tables" inference fit data words policy)
room(tools/explain experiment "the next experiment that separates two candidates" terms inference fit data words policy)
room(tools/explain refine "a term screened, and fitted with everything else" terms inference fit data words policy)
room(tools/explain search "rounds, terms of unknown law, and the decision about each" refine latent experiment terms inference fit data words policy)
room(tools/explain result "the result of a search as types: verdict, effects, estimates, residual, curves" search refine latent experiment terms inference fit data words policy)
room(tools/explain report "the result as JSON" result inference fit data words policy)

room(tools/files text "TOML with line and column, CSV lines, units, error messages")
room(tools/files model "model files" text)
room(tools/files record "records, their time grid, and recordings as records" text)
room(tools/files can "DBC, CAN map, candump logs" record model text)
room(tools/files rig "profiles of a lab and declared faults" model text)
room(tools/files exchange "records in the formats of other programs: MDF 4, HDF5, MATLAB" record text)
room(tools/files import "files of other programs as records, through a map or under a record's own names" exchange can record model text)

room(tools/study reference "an independent simulator of the axis, by CVODE")
room(tools/study draws "effects drawn at random, apart from the finder's terms" reference)
room(tools/study cases "cases: records with a known missing effect" draws reference)
room(tools/study tally "the results of the finder on each case, judged and counted" cases draws reference)

room(firmware text "formatted text, and JSON without a library; outside the loop")
room(firmware loop "the real-time loop: its pace, its overrun policy and its account of time")
room(firmware service "exit statuses, the watchdog and the units of the service manager" text)
room(firmware interlock "the numbered faults, their checks, and the states that decide whether the rig may drive")
room(firmware plant "the plant that a rig sees: the model with declared faults, recorded disturbances and sensor noise")
room(firmware image "the parameters of a plant as text from the host program" plant text)
room(firmware recording "the ring of cycles, and the thread that writes it to a file")
room(firmware live "what a running program shows: its cycles and counters, in memory that others read" recording)
room(firmware can "the CAN map, the codec and both sides of the bus" interlock)
room(firmware lab "profiles, and the logic that drives real actuators behind the interlock" can recording interlock image text)
room(firmware replay "a second run of a recording, compared bit for bit" lab image service text)
room(firmware session "one run from options to exit status" lab live can recording interlock image plant loop service text)
room(firmware report "what a run prints" session can text)

room(tools/interface plant "a plant of any topology behind tables of variables: steps, state, derivatives")
room(tools/interface c "the C interface and the reader of plant texts" plant)
room(tools/interface fmu "the functions of FMI 2.0 and 3.0 for co-simulation" c plant)

room(tools/cli shared "the list of commands, and options that several commands have")
room(tools/cli files "commands that check or convert files: new, check, convert, import, export, header" shared)
room(tools/cli model "commands that run, fit or describe a model: simulate, disperse, explain, linearise, loop, reduce, nastran, keys" shared)
room(tools/cli trials "commands for test profiles: sweep, step, stiffness, response, hammer, quiescent, strings, findings" shared)
room(tools/cli reference "man pages and completion of a shell, from the descriptions of --help" shared)
room(tools/cli rig "commands that start or prepare a real-time run: plant, controller, lab, timing, watch, replay, doctor" shared)

room(tests/model support "plants and vehicles for tests, and every effect with typical parameters")
room(tests/model laws "one law at a time: memories, delay lines, friction, modes, string potentiometers" support)
room(tests/model effects "laws that every effect obeys, run over the list of effects" support)
room(tests/model plants "laws of whole plants: one axis, a driven mass, a vehicle" support)
room(tests/model cvode "the model against the same equations integrated by CVODE" support)
room(tests/model cost "instructions of a step, counted" cvode support)
