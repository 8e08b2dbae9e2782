# shellcheck shell=bash disable=SC2154
# Sourced by tools/demo and tools/test: says what is being done and how long it has taken.

# Seconds as a person says them: "1 min 40 s".
spoken() {
  if [ "$1" -ge 60 ]; then echo "$(($1 / 60)) min $(($1 % 60)) s"; else echo "$1 s"; fi
}

# say_step NUMBER WHAT: a line "[2/5] building (1 min 40 s so far)"; `steps` holds how many there are.
say_step() {
  printf '[%d/%d] %s (%s so far)\n' "$1" "$steps" "$2" "$(spoken $SECONDS)"
}

# run_quietly NUMBER WHAT LOG COMMAND...: runs a long command with its output in LOG, and says every 20 s where it is. Returns
# the command's exit status; a failed command's last lines are shown unless its status is in `expected_statuses`.
run_quietly() {
  local number=$1 what=$2 log=$3 pid last status=0 waited=0
  shift 3
  say_step "$number" "$what"
  "$@" >"$log" 2>&1 &
  pid=$!
  while kill -0 "$pid" 2>/dev/null; do
    sleep 1
    waited=$((waited + 1))
    if [ $((waited % 20)) -eq 0 ]; then
      last=$(tail -c 400 "$log" | tr '\r' '\n' | grep . | tail -n 1 | cut -c1-90 || true)
      say_step "$number" "$what${last:+: $last}"
    fi
  done
  wait "$pid" || status=$?
  if [ "$status" -ne 0 ] && [[ " ${expected_statuses:-} " != *" $status "* ]]; then
    tail -n 40 "$log"
    echo "FAILED: $what (exit status $status); the whole output is in $log"
  fi
  return "$status"
}
