# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Completion for hotfire in bash. The program itself lists what may follow: `hotfire complete`.
_hotfire() {
  local current=${COMP_WORDS[COMP_CWORD]} word line words=() folders=
  COMPREPLY=()
  # bash makes three words of --option=value.
  for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do
    [ "$word" = "=" ] || words+=("$word")
  done
  if [ "$current" = "=" ]; then
    current=
    words+=("")
  fi
  while IFS= read -r line; do
    case $line in
      '*') mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- "$current") ;;
      '*'*)
        mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -X "!$line" -- "$current")
        folders=yes
        ;;
      *) COMPREPLY+=("$line") ;;
    esac
  done < <("${COMP_WORDS[0]}" complete -- "${words[@]}" 2>/dev/null)
  if [ -n "$folders" ]; then
    mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- "$current")
  fi
}
complete -o filenames -F _hotfire hotfire
