#!/usr/bin/env bash
# For Snakemake: how is this Slurm job? Asks the controller alone, so no accounting is needed.
state="$(scontrol --oneliner show job "$1" 2>/dev/null | sed -n 's/.* JobState=\([A-Z_]*\).*/\1/p')"
case "$state" in
  COMPLETED) echo success ;;
  PENDING | CONFIGURING | RUNNING | COMPLETING | SUSPENDED | REQUEUED | RESIZING) echo running ;;
  *) echo failed ;; # also when the controller has forgotten it: the job's output is looked at again next time
esac
