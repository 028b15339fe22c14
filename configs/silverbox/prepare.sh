#!/bin/sh
# Makes the records of the study from the recording, beside it (7 MB, not kept in the repository): rows FROM … TO of it, the first being 0.
set -e
cd "$(dirname "$0")"
rows() { awk -v from="$1" -v to="$2" 'NR == 1 || (NR >= from + 2 && NR <= to + 2)' snls80mV.csv; }
rows 40650 57033 > multisine.csv
rows 105712 127399 > multisine_test.csv
rows 100 40574 > arrow.csv
rows 40650 46649 > search.csv
