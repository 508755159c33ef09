#!/usr/bin/env bash
# For Snakemake: how is this Slurm job? Asks the controller alone, so no accounting is needed.
if ! answer="$(scontrol --oneliner show job "$1" 2>&1)" && [[ "$answer" != *"Invalid job id"* ]]; then
  echo running # a controller that is busy or restarting says nothing of the job: it is asked again
  exit
fi
case "$(sed -n 's/.* JobState=\([A-Z_]*\).*/\1/p' <<<"$answer")" in
  COMPLETED) echo success ;;
  PENDING | CONFIGURING | RUNNING | COMPLETING | SUSPENDED | REQUEUED | RESIZING) echo running ;;
  *) echo failed ;; # also when the controller has forgotten it: the job's output is looked at again next time
esac
