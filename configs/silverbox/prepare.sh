#!/bin/sh
# Makes the three records of the study from the recording, beside it (15 MB, not kept in the repository).
set -e
cd "$(dirname "$0")"
awk -v from=40650 -v to=57033 -f prepare.awk snls80mV.csv > multisine.csv
awk -v from=105712 -v to=127399 -f prepare.awk snls80mV.csv > multisine_test.csv
awk -v from=100 -v to=40574 -f prepare.awk snls80mV.csv > arrow.csv
awk 'NR == 1 || (NR >= 40652 && NR < 46652)' snls80mV.csv > search.csv
