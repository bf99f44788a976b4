/* report.h - output of a measured benchmark: table, CSV, JSON and plots. */
#pragma once
#include "accuracy/accuracy_benchmark.h"

#include <stdbool.h>

/* A table, one line per rung, followed by the reference and the paper's claim. name: of the document; "" for
   none. Times in ms, errors in linear intensity, angles in degrees. */
void wr_report_text(const WrAccuracyBenchmark *benchmark, const char *name, WrText *text);
/* A line of column names, then one line per rung; RFC 4180. Times in seconds. */
void wr_report_csv(const WrAccuracyBenchmark *benchmark, WrText *text);
/* {"reference":{...},"claim":{...},"rungs":[{...}]}; null for values that were not measured. */
void wr_report_json(const WrAccuracyBenchmark *benchmark, const char *name, WrText *text);
/* Writes the plot (plot.h) to a .svg, .pdf or .png file, atomically: the front is numbered and listed below, each setting
   in full. Errors: another extension; the file cannot be written. */
bool wr_report_plot(const WrAccuracyBenchmark *benchmark, const char *name, const char *path,
                    WrError *err);
