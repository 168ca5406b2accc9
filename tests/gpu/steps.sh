# Steps of tests/gpu/run: each has its own time limit and log; its result is in a file as soon as it is known, so that
# an end at any time leaves a summary of what was done. To be sourced; needs $out, $logs and $deadline (seconds of this
# shell).
# shellcheck shell=bash disable=SC2154,SC2004,SC2034

pack_time=12                            # Seconds for the final summary and archive.
pack_every=${COPSE_RUN_PACK_EVERY:-15}  # This and the next are changed only by its own test.
grace=${COPSE_RUN_GRACE:-8}             # Seconds from the signal at a limit to SIGKILL, and from SIGKILL to giving up.
steps=$logs/.steps
mkdir -p "$steps"
number=0
running=()  # Steps that run beside this shell.
exec {pause}<> <(:)  # Never delivers anything: a way to wait a moment without starting a program.

# If the deadline is shorter than the sum of the guarantees, each part gets its share of it.
share_out() {  # PART...
  local part sum=0 whole=$((deadline - pack_time))
  for part in "$@"; do sum=$((sum + guaranteed[$part])); done
  [ $sum -gt $whole ] || return 0
  for part in "$@"; do guaranteed[$part]=$((guaranteed[$part] * whole / sum)); done
}

# What a part may take: all the time left except what the parts after it are guaranteed.
left_for() {  # PART PART_AFTER...
  local seconds=$((deadline - SECONDS - pack_time)) part
  shift
  for part in "$@"; do seconds=$((seconds - guaranteed[$part])); done
  echo $((seconds > 1 ? seconds : 1))
}

state_of() {  # STATUS SECONDS LIMIT
  case $1 in
    0) echo passed ;;
    124) echo "cut off after $3 s" ;;
    137) if [ "$2" -ge "$3" ]; then echo "cut off after $3 s"; else echo "killed after $2 s"; fi ;;
    *) echo "failed with status $1" ;;
  esac
}

record() {  # FILE NAME STATE SECONDS
  printf '%s\t%s\t%s\n' "$2" "$3" "$4" >"$1.new" && mv "$1.new" "$1"
  printf '%-32s %4d s  %s\n' "$2" "$4" "$3"
  account
}

# Runs a command with its output in NAME.txt. CHECK is a function that gets NAME, the log and the state so far and
# prints the state: it may turn a pass into a failure if the log lacks something, or a failure into "skipped: WHY".
run_step() {  # FILE NAME LIMIT CHECK COMMAND...
  local file=$1 name=$2 limit=$3 check=$4 began=$SECONDS status log=$logs/$2.txt state signal=TERM child
  shift 4
  printf '%s\tnot finished\t0\n' "$name" >"$file"  # Until it is, or if everything ends first.
  case $name in bench* | variants) signal=INT ;; esac  # So that it writes what it has.
  # In the background, so that it does not delay a signal to this shell.
  timeout -s "$signal" -k "$grace" "$limit" "$@" >"$log" 2>&1 </dev/null &
  child=$!
  [ $BASHPID = $$ ] || trap 'kill $child 2>/dev/null' TERM
  # A process waiting for a hung GPU cannot even be killed, and whoever waits for it waits forever.
  while kill -0 "$child" 2>/dev/null && [ $((SECONDS - began)) -le $((limit + 2 * grace)) ]; do
    read -r -t 0.1 -u "$pause"
  done
  if kill -0 "$child" 2>/dev/null; then
    disown "$child"
    state="does not end, not even by SIGKILL"
  else
    wait "$child"
    status=$?
    state=$(state_of $status $((SECONDS - began)) "$limit")
  fi
  kill -KILL -- "-$child" 2>/dev/null  # What it started, if it was itself killed.
  [ -z "$check" ] || state=$("$check" "$name" "$log" "$state")
  record "$file" "$name" "$state" $((SECONDS - began))
  case $state in passed | skipped*) ;; *) grep -v '^not on ' "$log" | tail -n 5 | sed 's/^/    /' ;; esac
}

next_file() { number=$((number + 1)); printf -v file '%s/%03d' "$steps" $number; }

step() {  # NAME LIMIT CHECK COMMAND...
  next_file
  run_step "$file" "$@"
}

# The same, in parallel with others; `together` waits for all. At most $slots at a time.
beside() {  # NAME LIMIT CHECK COMMAND...
  next_file
  while still_running; [ ${#running[@]} -ge "$slots" ]; do wait -n "${running[@]}"; done
  run_step "$file" "$@" &
  running+=($!)
}
still_running() {
  local pid left=()
  for pid in "${running[@]}"; do ! kill -0 "$pid" 2>/dev/null || left+=("$pid"); done
  running=("${left[@]}")
}
together() {
  [ ${#running[@]} = 0 ] || wait "${running[@]}"
  running=()
}

skip() {  # NAME WHY
  next_file
  echo "skipped: $2" >"$logs/$1.txt"
  record "$file" "$1" "skipped: $2" 0
}

text_of() { local text=${1//\\/\\\\}; text=${text//\"/\\\"}; printf '"%s"' "${text//$'\t'/ }"; }

# summary.txt and summary.json, from the files of the steps.
account() {
  local file name state seconds comma='' failed=0 all=0 skipped=0 lines='' json=''
  for file in "$steps"/[0-9][0-9][0-9]; do
    [ -f "$file" ] || continue
    IFS=$'\t' read -r name state seconds <"$file"
    all=$((all + 1))
    case $state in passed) ;; skipped*) skipped=$((skipped + 1)) ;; *) failed=$((failed + 1)) ;; esac
    printf -v line '%-32s %4d s  %s\n' "$name" "$seconds" "$state"
    lines+=$line
    json+="$comma
  {\"name\": $(text_of "$name"), \"state\": $(text_of "$state"), \"seconds\": $seconds}"
    comma=,
  done
  {
    printf 'copse %s on %s, %s%s\n' "$commit" "$device" "$started" "$([ "$brief" = 1 ] && echo ', brief')"
    printf '%s%d steps: %d failed, %d skipped\n' "$lines" $all $failed $skipped
    # How many tests ran, and where.
    [ ! -s "$logs/tests.tsv" ] || sort "$logs/tests.tsv" |
      awk -F'\t' '{ printf "%-18s %5d of %5d test cases on %s, %9d assertions, %d failed\n", $1, $3, $4, $2, $5, $6 }'
  } >"$out/summary.txt.$BASHPID" && mv "$out/summary.txt.$BASHPID" "$out/summary.txt"
  printf '{"commit": %s, "device": "%s", "brief": %s, "time": "%s", "command": %s, "failed": %d, "skipped": %d,
 "steps": [%s]}\n' "$(text_of "$commit")" "$device" "$([ "$brief" = 1 ] && echo true || echo false)" "$started" \
    "$(text_of "$command")" $failed $skipped "$json" >"$out/summary.json.$BASHPID" &&
    mv "$out/summary.json.$BASHPID" "$out/summary.json"
}

failed_steps() {
  local file name state rest count=0
  for file in "$steps"/[0-9][0-9][0-9]; do
    IFS=$'\t' read -r name state rest <"$file"
    case $state in passed | skipped*) ;; *) count=$((count + 1)) ;; esac
  done
  echo $count
}
