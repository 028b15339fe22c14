#include "misfit/show/glossary.h"

#include <string>
#include <vector>

#include "misfit/core/text.h"
#include "misfit/data/estimators.h"
#include "misfit/data/verdict.h"

namespace misfit {

Glossary main_glossary() {
  return {
      {"study", "a folder with study.toml and data: one question put to one or more recordings"},
      {"system", "the skeleton of a model: states, inputs, outputs, quantities, ports, constants"},
      {"quantity", "a named function of state and input that effects read, with a unit: alpha_T [rad]"},
      {"port", "a named place where effects add up: a force, a rate, a quantity, an output"},
      {"role", "what an effect calls the quantities and ports that it acts on: [roles] of a system and a study say which are meant"},
      {"effect", "one physical cause: reads quantities, owns parameters, adds to ports"},
      {"strength, shape", "kinds of parameter: with all strengths 0 an effect is off; shapes are the rest"},
      {"random force", "what drives the motion beside the model, per degree of freedom, estimated by " +
                           std::string(random_force_estimator().name) +
                           "; smoothed over time it is the missing force, and what the model lacks is in it"},
      {"map",
       "the force that the model lacks, estimated as a function of one quantity or two, and the p with which chance alone gives as much"},
      {"fixed", "of a parameter: not estimated (free = false), but kept at its value"},
      {"held out", "of data: kept out of the estimation (validation), to test the model on them"},
      {"drop",
       "2 log likelihood ratio: by how much an effect improves the fit (predicted: by one step of a linearised model; actual: refitted); "
       "chance gives about 1 per parameter"},
      {"held-out gain",
       "gain of the log likelihood (not doubled), parameters uncertain, of the data that are held out: above 0, the effect predicts "
       "better"},
      {"family-wise p", "the probability that chance gives any one of all tested candidates such a drop; accepted below 0.01"},
      {"ladder, rung", "the sequence of models, each with one effect more; a rung is one of them"},
      {"verdict", "the answer in one sentence, and in verdict.json as one word of what the search ended with: " + [] {
         std::vector<std::string> kinds(verdict_names.begin(), verdict_names.end());
         return join_words(kinds);
       }() + " (not_decided: not tested to the end, or the best candidate of the last search was rejected, whatever was added before)"}};
}

Glossary further_glossary() {
  return {
      {"curve", "a parameter as a function of a quantity: a cubic spline with a roughness penalty"},
      {"driven", "motion excited by more than the model has: residuals are correlated, or a random force is estimated"},
      {"coloured noise",
       "the part of a channel's measurement noise that is not white: a damped resonance with a standard deviation and a frequency. "
       "It is looked for well above the motion; of waves or hum whose frequency is known: [noise] of the study, frequency"},
      {"trim", "the angle, or other level, at which the static force of a curve is 0 and pulls back on both sides"},
      {"samples ahead",
       "a prediction from a state that was corrected by the measurements so far, so many samples into the future; the error of one sample "
       "says little of what acts slowly, that of 32 much more"},
      {"free run", "the model simulated from its initial state and the inputs alone, never corrected by a measurement"},
      {"innovation", "a measurement less its prediction from all before it; of a right model these are white noise"},
      {"unknown form, unknown curve",
       "a force, or an error of an output, that follows a quantity in a way that no effect of the library has; unknown:PORT(QUANTITY) in "
       "lists. What it follows need not be its cause"},
      {"past of u",
       "recent changes of u that have not had their full effect yet; a missing force that follows it points to a delay, a lag or another "
       "memory"},
      {"time of day",
       "t modulo 24 h, from t = 0 of the recording on (midnight, where init read dates); looked at in recordings of three days and more"},
      {"lack of fit", "what is still significant beside an effect, as a curve of what it reads: the effect is there in another form"},
      {"candidate", "an effect, or an unknown curve, that the model may lack"},
      {"cell", "one combination of the shapes at which a candidate is tested; effective: how many independent tests the cells are worth"},
      {"sweep", "the static sweep: the rig at known angles, from which the camera is calibrated"},
      {"imitation",
       "a candidate that explains much, but with which a curve of a quantity that it reads is still significant: it may only imitate the "
       "missing effect"}};
}

}  // namespace misfit
