/* report.h - a measured ladder for people and for programs.
   Layer 6. */
#pragma once
#include "accuracy/ladder.h"

#include <stdbool.h>

/* A table, one line a rung, the reference and the paper's claim under it. name: of the document; "" for
   none. Times in ms, errors in linear intensity, angles in degrees. */
void wr_report_text(const WrLadder *ladder, const char *name, WrText *text);
/* One line a rung after a line of column names; RFC 4180. Times in seconds. */
void wr_report_csv(const WrLadder *ladder, WrText *text);
/* {"reference":{...},"claim":{...},"rungs":[{...}]}; null where nothing was measured. */
void wr_report_json(const WrLadder *ladder, const char *name, WrText *text);
/* The script of a plot of error against time with the front marked, for gnuplot; terminal: "pngcairo" or
   "svg". It writes to standard output. */
void wr_report_plot_script(const WrLadder *ladder, const char *name, const char *terminal,
                           WrText *text);
/* The same plot to a .png or .svg file, drawn by gnuplot, as a whole replacement. Errors: another ending;
   gnuplot is not installed or fails, with its own words. */
bool wr_report_plot(const WrLadder *ladder, const char *name, const char *path, WrError *err);
