/* report.h - output of a measured ladder: table, CSV, JSON and plots. */
#pragma once
#include "accuracy/ladder.h"

#include <stdbool.h>

/* A table, one line per rung, followed by the reference and the paper's claim. name: of the document; "" for
   none. Times in ms, errors in linear intensity, angles in degrees. */
void wr_report_text(const WrLadder *ladder, const char *name, WrText *text);
/* A line of column names, then one line per rung; RFC 4180. Times in seconds. */
void wr_report_csv(const WrLadder *ladder, WrText *text);
/* {"reference":{...},"claim":{...},"rungs":[{...}]}; null for values that were not measured. */
void wr_report_json(const WrLadder *ladder, const char *name, WrText *text);
/* Gnuplot script of a plot of error against time with the front marked; terminal: "pngcairo" or "svg". It writes
   to standard output. */
void wr_report_plot_script(const WrLadder *ladder, const char *name, const char *terminal,
                           WrText *text);
/* Writes that plot to a .png or .svg file, drawn by gnuplot, atomically. Errors: another extension; gnuplot is
   not installed or fails, with its own message. */
bool wr_report_plot(const WrLadder *ladder, const char *name, const char *path, WrError *err);
