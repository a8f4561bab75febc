#!/usr/bin/env bash
# buddy.sh BIN: ranks with folders of their own, as on different hosts, keep buddy copies. A rank dies and its folder is
# lost: the others restart with the result of a run that never stopped. Two lost folders of buddies are refused by name.
source "$(dirname "$0")/../../support/checks.sh"
bin=$(cd "$1" && pwd)
job=$bin/test_checkpoint_job
stencil=$bin/stencil
where=$scratch/hosts
root=$(cd "$(dirname "$0")/../../.." && pwd)

# on_hosts "HOSTS" COMMAND…: one rank in each of these folders, which stand for hosts.
on_hosts() {
  local hosts=$1 all=() host
  shift
  for host in $hosts; do
    mkdir -p "$where/$host"
    all+=(${all:+:} -n 1 -wdir "$where/$host" "$@")
  done
  exec timeout 100 "${mpirun[@]}" "${all[@]}"
}
# runs "HOSTS" COMMAND…: exit code 0.
runs() {
  (on_hosts "$@") >"$scratch/out" 2>&1 && pass && return
  fail "$*"
  tail -5 "$scratch/out"
}
log_of() { sed -n 's/^from [0-9]* log //p' "$scratch/out"; }
same() { [[ -n $2 && $1 == "$2" ]] && pass || fail "the log is $2, not $1"; }
lose() { for host in "$@"; do rm -rf "${where:?}/$host"; done; }

# All kinds of chares: each of four hosts is lost in turn, a fifth one takes its place or not.
runs "a" "$job" whole 8 --pes 3
want=$(log_of)
for lost in a b c d; do
  lose a b c d e
  runs "a b c d" "$job" saved 4 buddy --pes 2
  for host in a b c d; do
    (($(ls "$where/$host/saved/checkpoint-000002"/pe-?.copy | wc -l) == 2)) && pass || fail "host $host has not two copies"
    (($(ls "$where/$host/saved/checkpoint-000002" | wc -l) == 6)) && pass || fail "host $host has other files"
  done
  lose "$lost"
  others=$(tr -d "$lost" <<<"a b c d")
  [[ $lost == [ab] ]] && others="e $others"
  runs "$others" "$job" saved 8 buddy-restart --pes 1
  says '^from 4 '
  same "$want" "$(log_of)"
done
# The members of a group come back to their PEs, whichever PE reads their files.
lose a b c d e
runs "a b a b" "$job" saved 4 buddy --pes 1
runs "a b a b" "$job" saved 8 buddy-restart --pes 1
same "$want" "$(log_of)"
# From one of two folders, and the host of PE 0 is new: the run goes on with the other folder.
lose a b
runs "a b" "$job" saved 4 buddy --pes 1
for host in a b; do cp -r "$where/$host/saved" "$where/$host/disk"; done
mv "$where/a" "$where/e"
rm -rf "$where/e/saved"
runs "e b" "$job" saved 8 buddy-restart disk --pes 1
says '^from 4 '
same "$want" "$(log_of)"
# The two hosts of a pair of buddies are lost.
lose a b c d e
runs "a b c d" "$job" saved 4 buddy --pes 1
lose b c
(on_hosts "a d" "$job" saved 8 buddy-restart --pes 2) >"$scratch/out" 2>&1
(($? == 2)) && pass || fail "two lost hosts: exit code"
says 'a checkpoint is refused: saved/checkpoint-000002/pe-1 is on no host of this run, nor is its copy pe-1.copy'
# Damaged on one host, good on the other.
lose a b
runs "a b" "$job" saved 4 buddy --pes 1
truncate -s -1 "$where/b/saved/checkpoint-000002/pe-1"
truncate -s -1 "$where/a/saved/checkpoint-000002/main"
runs "a b" "$job" saved 8 buddy-restart --pes 3
says 'a file of a checkpoint is refused: saved/checkpoint-000002/pe-1 has .*; its copy is used'
says 'a file of a checkpoint is refused: saved/checkpoint-000002/main has .*; its copy is used'
same "$want" "$(log_of)"

# A rank of the stencil is killed at a random moment; its host's folder is lost.
what=(--size 256 --steps 1500 --pes 1)
runs "a" "$stencil" "${what[@]}" --json "$scratch/want.json"
for n in 2 4; do
  lose a b c d
  hosts=$(cut -d' ' -f1-$n <<<"a b c d")
  (on_hosts "$hosts" "$stencil" "${what[@]}" --checkpoint saved --checkpoint-every 20 --checkpoint-buddy) >"$scratch/killed" 2>&1 &
  child=$!
  while kill -0 $child 2>/dev/null && ! compgen -G "$where/a/saved/checkpoint-*4/manifest.json" >/dev/null; do sleep 0.01; done
  sleep "0.0$((RANDOM % 10))"
  victim=$(pgrep -P "$(pgrep -P $child | head -1)" | sed -n 2p)
  [[ -n $victim ]] && kill -9 "$victim" 2>/dev/null && pass || fail "no rank to kill: $(tail -3 "$scratch/killed")"
  wait $child
  lose b
  rm -f "$scratch/result.json"
  runs "${hosts/b /}" "$stencil" --pes 2 --restart saved --steps 1500 --json "$scratch/result.json"
  says '^continues after step [1-9]'
  same_results "$scratch/want.json" "$scratch/result.json" && pass || fail "another result after the loss of a host of $n"
done

# run_forever.sh on one host, with the folder in memory: a rank is killed, and the next run goes on.
folder=$(mktemp -d -p /dev/shm)
trap 'rm -rf "$scratch" "$folder"' EXIT
cat >"$scratch/dies" <<END
#!/usr/bin/env bash
# The first run loses a rank once it has written a checkpoint.
${mpirun[@]} -n 2 "$stencil" "\$@" &
child=\$!
if [[ ! -e "$scratch/died" ]]; then
  touch "$scratch/died"
  while kill -0 \$child 2>/dev/null && ! compgen -G "$folder/saved/*/manifest.json" >/dev/null; do sleep 0.01; done
  kill -9 "\$(pgrep -P \$child | tail -1)"
fi
wait \$child
END
chmod +x "$scratch/dies"
timeout 200 bash "$root/apps/run_forever.sh" "$folder/saved" "$scratch/dies" "${what[@]}" --checkpoint-every 50 --checkpoint-buddy --json "$scratch/result.json" >"$scratch/out" 2>&1 && pass || fail "run_forever.sh"
says 'it is started again from checkpoint-'
says '^continues after step [1-9]'
same_results "$scratch/want.json" "$scratch/result.json" && pass || fail "another result of run_forever.sh"
finish
