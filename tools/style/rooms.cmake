# The rooms inside the larger folders: what each one is for, and below each room the rooms of the same folder that its files
# may include. A file beside the rooms may include all of them; no room includes a file beside the rooms. Checked by
# layering.cmake; drawn into docs/architecture.md by draw_rooms.cmake.

set(houses tools/explain tools/files tools/study firmware tools/interface)

# room(HOUSE NAME "what it is for" ROOM_BELOW...): rooms are declared from the lowest up.
macro(room house name purpose)
  list(APPEND rooms_of_${house} ${name})
  set(below_${house}/${name} ${ARGN})
  set(purpose_of_${house}/${name} "${purpose}")
endmacro()

room(tools/explain data "records as the finder uses them: rows to fit, to hold out, to exclude; noise; start states")
room(tools/explain fit "simulation error, exact gradients and the least-squares fit" data)
room(tools/explain inference "confidence intervals, identifiability and statistics of the residual" fit data)
room(tools/explain latent "an unknown signal at each place: where the missing term acts" fit data)
room(tools/explain terms "candidates: listed effects, and terms of unknown law with their tables" inference fit data)
room(tools/explain experiment "the next experiment that separates two candidates" terms inference fit data)
room(tools/explain search "screening, joint fits and the decision about each term" latent experiment terms inference fit data)
room(tools/explain report "the result as JSON, sentences and curves" search latent experiment terms inference fit data)

room(tools/files text "TOML with line and column, CSV lines, units, error messages")
room(tools/files model "model files" text)
room(tools/files record "records, their time grid, and recordings as records" text)
room(tools/files can "DBC, CAN map, candump logs" record model text)
room(tools/files rig "profiles of a lab and declared faults" model text)
room(tools/files import "CSV, MATLAB and CAN files of other programs as records" can record model text)

room(tools/study reference "an independent simulator of the axis, by CVODE")
room(tools/study draws "effects drawn at random, apart from the finder's terms" reference)
room(tools/study cases "cases: records with a known missing effect" draws reference)
room(tools/study tally "the results of the finder on each case, judged and counted" cases draws reference)

room(firmware text "formatted text, and JSON without a library; outside the loop")
room(firmware loop "the real-time loop: its pace, its overrun policy and its account of time")
room(firmware service "exit statuses, the watchdog and the units of the service manager" text)
room(firmware interlock "the numbered faults, their checks, and the states that decide whether the rig may drive")
room(firmware plant "the plant that a rig sees: the model with declared faults and sensor noise")
room(firmware image "the parameters of a plant as text from the host program" plant text)
room(firmware recording "the ring of cycles, and the thread that writes it to a file")
room(firmware can "the CAN map, the codec and both sides of the bus" interlock)
room(firmware lab "profiles, and the logic that drives real actuators behind the interlock" can recording interlock image text)
room(firmware replay "a second run of a recording, compared bit for bit" lab image service text)
room(firmware session "one run from options to exit status" lab can recording interlock image plant loop service text)
room(firmware report "what a run prints" session can text)

room(tools/interface plant "a plant of any topology behind tables of variables: steps, state, derivatives")
room(tools/interface c "the C interface and the reader of plant texts" plant)
room(tools/interface fmu "the functions of FMI 2.0 and 3.0 for co-simulation" c plant)
