#!/usr/bin/env bash
# Each misuse ends the job on every machine with exit code 1 and a line that says what is wrong and where.
#
#     misuse.sh MPIEXEC PROGRAM CHECKS
#
# CHECKS: TESS_CHECKS of the build.
source "$(dirname "$0")/../support/checks.sh"
program=$2 checks=$3
threads=("$program")
simulated=("$program")
processes=("$1" "${mpirun_options[@]}" -n 2 "$program")
on_threads=(--pes 2)
on_simulated=(--sim pes=2,per-process=1,cost=100ns)
on_processes=(--pes 1)
out=$scratch/out

# says WHERE MISUSE PATTERN…: on that machine the misuse ends with exit code 1 and matches all patterns.
says() {
  local -n command=$1 options=on_$1
  local where=$1 misuse=$2 code missing=""
  shift 2
  timeout -k 5 30 "${command[@]}" "$misuse" "${options[@]}" >"$out" 2>&1 </dev/null
  code=$?
  for pattern in "$@"; do
    grep -q -- "$pattern" "$out" || missing+=" '$pattern'"
  done
  if ((code == 1)) && [[ -z $missing ]]; then
    pass
  else
    fail "$misuse on $where: exit code $code, not found:$missing"
    head -8 "$out"
  fi
}
# everywhere MISUSE PATTERN…; here: without mpirun, which takes longest.
here() {
  says threads "$@"
  says simulated "$@"
}
everywhere() {
  here "$@"
  says processes "$@"
}

everywhere member_99 "^tessera: there is no PE 99: the run has 2 PEs" "on PE 0" "^  the check is .* at runtime/"
here member_-1 "there is no PE -1"
everywhere insert_on_77 "there is no PE 77"
everywhere map_too_far "the map .*ToItsNumber puts Block\[2\] on PE 2, but the run has PEs 0 … 1: compute the PE from the number of PEs"
here migrate_to_-3 "there is no PE -3"
here move_to_55 "there is no PE 55" "on PE 0, Block\[1\], in Block::move"
everywhere empty_callback "an empty Callback<int> is called" "Block\[2\], in Block::answer"
here empty_target "contributes, but its Callback<int> for the result is empty"
everywhere exit_-1 "exit(-1): an exit code is a number of 0"
everywhere exit_256 "exit(256): an exit code is a number of 0"
everywhere throw_inserted "the mould is broken" "Block\[7\], in the constructor Block(int)"
here throw_in_epoch "the mould is broken" "Block\[7\], in the constructor Block(int)"
here throw_caught "the mould is broken" "Block\[7\], in the constructor Block(int)"
here map_throws_in_epoch "the map is torn"
here throw_initial "the mould is broken" "Block\[0\], in the constructor Block(int)"
here check_inserted "the mould is wrong" "on PE 0, Block\[7\], in the constructor"
everywhere different_targets "contributions to one reduction have different targets: " "Block::take of Block\\[0\\]" "Block::take of Block\\[1\\]"
everywhere insert_between_rounds "Overlap\[1\] was created after broadcast 1 and contributes to Overlap: reduction 0, to which broadcast 1 led: rounds overlap, or it contributes without having received the broadcast; insert elements while no round is under way"
everywhere insert_unawaited "Driven\[2\] contributes first to Driven: reduction .*, by a message that no broadcast of its array led to, but its insertion was not awaited: .* name the rounds, insert(tess::RoundId{k}, …) and contribute(tess::RoundId{k}, …)"
everywhere join_too_late "Driven\[1\] is inserted to join at round 0, but Driven: reduction 0 is complete"
here join_before_all "Driven\[1\] cannot join at round -1: rounds are numbered from 0"
everywhere round_twice "Driven\[1\] contributes to round 0 again, or before it joined: it has not contributed to round 1 yet"
here round_far_ahead "Driven\[1\] contributes to round 64, but it has not contributed to round 0: it may be ahead by 63 rounds"
here end_in_a_gap "Driven\[1\] ends before it contributes to round 0, but it has contributed to a later one"
here different_operations "operations .*Scaled of different state"
here await_every "deadlock: .* 1 wait" "waits for a future of void" "note: 1 timer of every() is set: a run does not wait"
everywhere different_values "contributions to one reduction have different values, operations or results: .*MergedPartial<int, \\(Sum\\|Max\\), int> and "
here any_of_none "when_any() of an empty vector has no first result: give at least one"
here empty_proxy "a message to an empty ElementProxy<.*Block>: assign array\\[index\\], or what create() gives, to it first"
here index_of_64_bits "an index is 4294967296, but a coordinate has 32 bits"
here empty_array "a broadcast of Block::nothing to an empty proxy: assign what create() returned to it first"
everywhere empty_array_target "a broadcast of Block::nothing to an empty proxy"
here empty_array_size "a use of an empty proxy: assign what create() returned to it first"
here empty_array_ends "destroy() of an empty proxy: assign what create() returned to it first"
here empty_group "a broadcast of Member::nothing to an empty proxy"
here empty_group_local "a use of an empty proxy: assign what create() returned to it first"
everywhere future_awaited_twice "a future of .*string.* is awaited again: the first co_await took its result"
here nested_tasks "tasks call tasks so deep that the stack of this PE ends"
here task_awaited_at_once "two coroutines await one task"
here value_awaited_twice "a task is awaited again: the first co_await took its result"
everywhere ask_awaited_twice "the reply of Block\[1\].news is awaited again: the first co_await took it"
here future_given_two "a result came for a future that has its result already or was destroyed: give it one"
# Between processes, and with all checks, the element is made anew, with a future of its own.
if [[ $checks != all ]]; then
  says threads future_after_move "a future of PE 0 is used on PE 1: its element has migrated before its result was there" "Hasty\\[0\\]"
  says threads future_left_early "a future of PE 0 is used on PE 1: its element has migrated before its result was there" "Keeper\\[0\\]"
fi
says processes future_left_early "a result came for a future that has its result already or was destroyed: .* an element that keeps one does not migrate before"
# The result, too, is left behind: a future is not serialised.
says processes future_left_late "deadlock: .* 1 wait" "Keeper\\[0\\] on PE 1: Keeper::use waits for a future of int"
# Within a process the pointer is passed on as it is.
says processes derived_in_a_pointer "a unique_ptr to Shape holds a Circle, of which only the base class would be sent"
here negative_argument "an argument is -1, but the entry method takes 0 to 18446744073709551615"
here negative_later "an argument is -1, but the entry method takes 0 to 18446744073709551615"
here negative_ask "an argument is -1, but the entry method takes 0 to 18446744073709551615"
everywhere mean_of_none "uncaught exception: the mean of no values" "on PE ., at the end of a reduction of Meter"
here ordered_mean_of_none "the mean of no values" "on PE ., at the end of a reduction of Meter"
here section_mean_of_none "the mean of no values" "on PE ., at the end of a reduction of a section of Meter"
everywhere stranger_votes "Stranger\[7\] contributes to a section that it is no member of"
here strangers_vote "Stranger\[7\] contributes to a section that it is no member of"
everywhere destructor_sends "the destructor of Parting calls the runtime after the end of the run: destroy() the array or group before"
here destructor_contributes "Leaver\[1\] contributes in its destructor: contribute before destroy()"
timeout -k 5 30 "$program" torn_sum --pes 2 >"$out" 2>&1 </dev/null
(($? == 2)) && grep -q "error: the sum is torn" "$out" && pass || fail "torn_sum"
here sleep_twice "two coroutines await one sleep()"
here work_of_the_past "charge(-1ns): work takes time"
here array_not_known "the array of this proxy is not known yet on PE 0: create it inside an awaited epoch"
here group_not_known "this group is not known yet on PE 0: create it inside an awaited epoch"
here array_after_end "the array of this proxy was destroyed on PE 0"
everywhere run_in_a_run "run() is called inside a run: a program has one run at a time"
here setup_again "run() with a Setup that has run: make one for each run"
everywhere proxy_of_the_past "1 message on PE . waits for the array or group [0-9]*, which is not known there: is the proxy of an earlier run?"
here balance_after_end "start_balancing() of an array that was destroyed on PE 0"
here group_after_end "this group was destroyed on PE 0"
everywhere sum_of_none "waits for a future of int" "Block has no elements: its reductions have no result"
everywhere sum_of_empty_section "waits for a future of int" "a section of Block has no elements: its reductions have no result"
everywhere place_77 "place() of .*Placed<77> puts the element \[4\] on PE 77, but the run has 2 PEs"
here place_-2 "place() of .*Placed<-2> puts the element \[0\] on PE -2, but the run has 2 PEs"
here section_twice "the list of a section of .*Block has the index \[0\] twice"
here section_empty "a broadcast to an empty SectionProxy<.*Block>: assign create_section() to it first"
here section_empty_ends "destroy() of an empty SectionProxy<.*Block>: assign create_section() to it first"
everywhere section_without_element "waits for a future of int" "1 message (of the runtime, as for a section with it) on PE . to .*Stranger\[6\], which does not exist"
everywhere section_in_an_epoch "the epoch that create_section() of .*Stranger ran in waits for .*Stranger\[6\], which does not exist: call it outside of the epoch"
here section_of_another "Stranger\[1\] contributes to a section of another array"
# What reads other bytes than it wrote, between processes. (With TESS_CHECKS=all it is found where it is sent.)
for kind in short long; do
  says simulated ${kind}_element "Uneven<[01]> *>\[0\]\|Uneven<[01]>: " "serialize()"
  says simulated ${kind}_argument "Uneven<[01]> *>::hear\|Uneven<[01]>: " "serialize()"
  says simulated ${kind}_broadcast "Uneven<[01]> *>::hear\|Uneven<[01]>: " "serialize()"
  says simulated ${kind}_sum "MergedPartial<Uneven<[01]>, Sum, Uneven<[01]> *>: " "serialize()"
done
# What throws while it is read, where no entry method runs that could be named. (With TESS_CHECKS=all it throws where it is sent.)
thrown="Refused.*: serialize() threw while it read [0-9]* bytes: the value is refused"
argument=$thrown heard="Refused>::hear.*: the value is refused"
if [[ $checks == all ]]; then argument="uncaught exception: the value is refused" heard=$argument; fi
says simulated refused_element "Refused>\[0\]: serialize() threw while it read .*: the value is refused\|Refused: "
says simulated refused_argument "$argument"
says simulated refused_broadcast "$thrown"
says simulated refused_sum "$thrown"
says processes refused_argument "$heard"
says simulated unclear_argument "an exception that is not a std::exception"
# What throws while it is written: the run ends also if the program keeps the exception. (With TESS_CHECKS=all it throws before it
# counts as sent.)
for misuse in unwritten_argument unwritten_broadcast; do
  says simulated $misuse "uncaught exception: the value stays here" "on PE 0"
done
says simulated unwritten_element "uncaught exception: the value stays here" "on PE 0, .*Carrier<.*Unwritten>\\[0\\]"
[[ $checks == all ]] || says simulated unwritten_and_caught "uncaught exception: the value stays here" "on PE 0"
says processes unwritten_argument "uncaught exception: the value stays here" "on PE 0"
says processes short_element "Uneven<0> \?>\[0\]\|Uneven<0>: " "serialize()"

finish
