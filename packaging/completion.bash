# SPDX-License-Identifier: MIT
# Completion of beamgyro for bash; the tables are made from the program's help.

_beamgyro_commands() {
  # commands
}

_beamgyro_options() {
  case "$1" in
    # options
  esac
}

# What the value of COMMAND:OPTION may be: words, @files ENDING..., or
# @directories. Without an answer the option is a flag.
_beamgyro_values() {
  case "$1" in
    # values
    *) return 1 ;;
  esac
}

_beamgyro_arguments() {
  case "$1" in
    # arguments
  esac
}

# Answers with the files of these endings, or all files, and directories.
_beamgyro_files() {
  local word=$1 ending file
  shift
  compopt -o filenames 2>/dev/null
  while IFS= read -r file; do
    if [ -d "$file" ] || [ $# -eq 0 ]; then
      COMPREPLY+=("$file")
      continue
    fi
    for ending in "$@"; do
      [[ $file != *".$ending" ]] || COMPREPLY+=("$file")
    done
  done < <(compgen -f -- "$word")
}

# Completes WORD by what a table says.
_beamgyro_answer() {
  local word=$1 kind=$2
  case "$kind" in
    "@files"*)
      # shellcheck disable=SC2086  # endings
      _beamgyro_files "$word" ${kind#@files}
      ;;
    @directories)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -d -- "$word")
      ;;
    *) mapfile -t COMPREPLY < <(compgen -W "$kind" -- "$word") ;;
  esac
}

_beamgyro() {
  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local command="" at kind
  COMPREPLY=()
  for ((at = 1; at < COMP_CWORD; at++)); do
    [[ ${COMP_WORDS[at]} == -* ]] || { command=${COMP_WORDS[at]}; break; }
  done
  # bash takes "--option=value" for three words.
  if [ "$word" = "=" ]; then
    word=""
  elif [ "$previous" = "=" ] && ((COMP_CWORD > 2)); then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  if [ -z "$command" ] && [[ $word == -* ]]; then
    _beamgyro_answer "$word" "$(_beamgyro_options "")"
  elif [ -z "$command" ] || [ "$command" = help ]; then
    _beamgyro_answer "$word" "$(_beamgyro_commands)"
  elif kind=$(_beamgyro_values "$command:$previous"); then
    _beamgyro_answer "$word" "$kind"
  elif [[ $word == -* ]]; then
    _beamgyro_answer "$word" "$(_beamgyro_options "$command")"
  else
    _beamgyro_answer "$word" "$(_beamgyro_arguments "$command")"
  fi
}

complete -F _beamgyro beamgyro
