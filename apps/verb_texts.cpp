#include "apps/verb_texts.h"

namespace misfit {
namespace {

constexpr VerbText texts[] = {
    {"run", "run all stages of the study and write the report; stages whose inputs have not changed are skipped",
     "the study and the data that it names", "the results of track to discover, report.html, figures/, run.json, resolved.toml",
     "misfit run configs/swivel_friction"},
    {"track", "follow a marker, or the object that moves, through the video: track.csv, contact sheet, lost samples and their reasons",
     "the study, its videos and pictures of the static sweep", "track.csv, track.json, figures/contact_sheet.png",
     "misfit track flight --check-video track.avi"},
    {"calibrate", "estimate camera height, scale and the further parameters that the static sweep supports",
     "the study, its static sweep (CSV)", "camera.json", "misfit calibrate flight"},
    {"attitude", "compute the angles of the axis from the track", "the study, track.csv, camera.json", "attitude.csv",
     "misfit attitude flight"},
    {"fit", "estimate the model's curves and parameters", "the study, its data or attitude.csv",
     "fit/METHOD/fit.json, curves.csv, prediction.csv", "misfit fit motor --method output_error"},
    {"diagnose", "residual diagnostics: unexplained force against states, inputs and time; whiteness tests",
     "the study, its data, the fit with a random force", "diagnosis.json, missing_force.csv", "misfit diagnose motor"},
    {"discover", "rank the effects the model may be missing; continues from the last model of the ladder",
     "the study, its data, the fit with a random force",
     "candidates.json, discovery.json, added_force.csv, report.html; with --auto also rungs/ and ladder.json",
     "misfit discover motor --auto"},
    {"add", "add an effect (or system:KIND) to the last rung: writes and fits a new study, prints the error before and after",
     "the study and its ladder", "rungs/NN_EFFECT/ with the new study and its results, ladder.json", "misfit add motor coulomb_friction"},
    {"remove", "take a rung and those above it off the ladder; what they computed is kept in rungs/removed_NN_EFFECT",
     "the study and its ladder", "ladder.json, report.html", "misfit remove motor coulomb_friction"},
    {"set",
     "change values in the text of the study, which keeps its layout and comments: estimate or fix a parameter, hold out another part",
     "the study", "the study, if nothing is wrong with it then", "misfit set motor parameters.k.free=false"},
    {"compare", "compare methods with each other and with reference curves, simulated with measured motion",
     "the study, its fits, curves of [reference]", "compare.json", "misfit compare configs/null"},
    {"uncertainty", "propagate geometry, camera and mass uncertainty to the results (Monte Carlo, on threads or under mpirun)",
     "the study with its section [uncertainty], its data", "uncertainty.csv, uncertainty.json, bootstrap.json, profile.json, starts.json",
     "misfit uncertainty flight --runs 1000"},
    {"report", "write the figures and one self-contained page; fits that are missing or out of date are made first",
     "the study and what the other verbs have written", "report.html, figures/ (SVG, CSV, gnuplot script)", "misfit report motor"},
    {"open", "look, click, add: the page of the study in a browser, from this machine alone; its clicks are commands, kept in session.sh",
     "the study and what the other verbs have written", "what its commands write, session.sh; the study, when its text is saved",
     "misfit open configs/swivel_friction"},
    {"simulate", "simulate the model as described in [simulate], or as fitted", "the study, or its last fit", "simulation.csv",
     "misfit simulate motor"},
    {"batch", "fit many studies as one job, on threads or under mpirun; tabulate how their results vary",
     "lists with one study per line, folders, studies", "batch.csv, batch.json in batch/ beside the list", "misfit batch flights.txt"},
    {"export", "write the estimate for other programs: curves and parameters with covariance, as a model in C or Python, for JSBSim",
     "the study and the estimate that lies in its run folder; nothing is fitted",
     "estimate.json, model.c, model.py, aerodynamics.xml or tables (CSV) in export/, or PATH; SI and radians",
     "misfit export motor --to python --out motor.py"},
    {"init", "write a first study for a recording: column roles, linear model, figures",
     "a recording: CSV, MAT, HDF5, NPY, NPZ, ULog, DataFlash .bin",
     "a folder named after the file: study.toml, model.toml, the data as CSV, figures/", "misfit init motor.csv"},
    {"effects", "list the effects of the program, or of a study; with the key of an effect, print it in full", "nothing, or a study",
     "nothing", "misfit effects coulomb_friction"},
};

}  // namespace

std::span<const VerbText> verb_texts() { return texts; }

}  // namespace misfit
