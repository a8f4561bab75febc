#!/usr/bin/env bash
# run_forever.sh FOLDER COMMAND…: runs a program that takes --checkpoint and --restart (stencil, leanmd, amr, nqueens) to its
# end. If it dies, it is started again from the last good checkpoint in FOLDER:
#
#     apps/run_forever.sh saved mpirun -n 4 build/release/bin/stencil --steps 1000000 --checkpoint-every 60s
#
# It gives up after five runs in a row that wrote no checkpoint. It does not start again after a bad option (exit code 2)
# nor after SIGINT and SIGTERM: the program ends with 130 or 143, or this script has the signal, too, as after Ctrl-C. (mpirun
# ends with 1 then. A SIGTERM to mpirun only looks like a failure, and the program is started again; one to this script only
# takes effect when the program ends: send it to the process group.)
set -u
if (($# < 2)); then
  echo "usage: run_forever.sh FOLDER COMMAND…" >&2
  exit 2
fi
folder=$1
shift
latest() { (cd "$folder" 2>/dev/null && ls -d checkpoint-*/manifest.json 2>/dev/null | sort -t- -k2 -n | tail -1 | cut -d/ -f1); }
stopped=
trap 'stopped=130' INT
trap 'stopped=143' TERM
in_vain=0
while [[ -z $stopped ]]; do
  before=$(latest)
  "$@" --checkpoint "$folder" ${before:+--restart "$folder"}
  code=$?
  case $code in
    0 | 2 | 130 | 143) exit $code ;;
  esac
  [[ -z $stopped ]] || break
  after=$(latest)
  if [[ $after == "$before" ]]; then
    in_vain=$((in_vain + 1))
  else
    in_vain=0
  fi
  if ((in_vain == 5)); then
    echo "run_forever.sh: five runs in a row wrote no checkpoint; the last ended with exit code $code" >&2
    exit "$code"
  fi
  echo "run_forever.sh: the run ended with exit code $code; it is started again from ${after:-the beginning}" >&2
done
exit "$stopped"
