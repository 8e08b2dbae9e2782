# The rooms inside the larger folders: what each one is for, and below each room the rooms of the same folder that its files
# may include. A file beside the rooms may include all of them; no room includes a file beside the rooms. Checked by
# layering.cmake; drawn into docs/architecture.md by draw_rooms.cmake.

set(houses tools/explain tools/files tools/study firmware)

# room(HOUSE NAME "what it is for" ROOM_BELOW...): rooms are declared from the lowest up.
macro(room house name purpose)
  list(APPEND rooms_of_${house} ${name})
  set(below_${house}/${name} ${ARGN})
  set(purpose_of_${house}/${name} "${purpose}")
endmacro()

room(tools/explain data "records as the finder uses them: rows to fit, to hold out, to exclude; noise; start states")
room(tools/explain fit "simulation error, exact gradients and the least-squares fit" data)
room(tools/explain inference "intervals, identifiability and what is left of a fit" fit data)
room(tools/explain latent "an unknown signal at each place: where the missing term acts" fit data)
room(tools/explain terms "candidates: listed effects, and terms of unknown law with their tables" inference fit data)
room(tools/explain experiment "the next experiment that separates two candidates" terms inference fit data)
room(tools/explain search "screening, joint fits and the decision which term stays" latent experiment terms inference fit data)
room(tools/explain report "the result as JSON, sentences and curves" search latent experiment terms inference fit data)

room(tools/files text "TOML with positions, CSV lines, units, messages")
room(tools/files model "model files" text)
room(tools/files record "records, their time grid, and recordings as records" text)
room(tools/files can "DBC, CAN map, candump logs" record model text)
room(tools/files rig "profiles of a lab and declared faults" model text)
room(tools/files import "other people's files as records" can record model text)

room(tools/study reference "an independent simulator of the axis, by CVODE")
room(tools/study draws "effects drawn at random, apart from the finder's terms" reference)
room(tools/study cases "cases: records with a known missing effect" draws reference)
room(tools/study tally "what the finder said of a case, judged and counted" cases draws reference)

room(firmware text "numbers and JSON as text, without allocation")
room(firmware loop "the real-time loop, its pace and its account of time")
room(firmware service "exit status, watchdog and units of the service manager" text)
room(firmware interlock "states of the rig, faults and what they lead to")
room(firmware plant "the plant that a rig sees: model, declared faults, sensor noise")
room(firmware image "a plant's parameters as text from the host program" plant text)
room(firmware recording "the recorder and its ring")
room(firmware can "frames on the bus, both directions" interlock)
room(firmware lab "a real actuator through a profile, behind the interlock" can recording interlock image text)
room(firmware replay "a recording run again, bit for bit" lab image service text)
room(firmware session "one run from options to exit status" lab can recording interlock image plant loop service text)
room(firmware report "what a run prints" session can text)
