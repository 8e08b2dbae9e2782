# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Completion for hotfire-rt in bash, from what `hotfire-rt MODE --help` prints. It needs nothing of the host programs.
_hotfire_rt() {
  local current=${COMP_WORDS[COMP_CWORD]}
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "plant controller lab timing replay --help --version" -- "$current")
  elif [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" "${COMP_WORDS[1]}" --help | sed -n '/^Options with/q; s/^  \(--[a-z-]*\).*/\1/p')" -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}
complete -o filenames -F _hotfire_rt hotfire-rt
