/* line_words.h - a step of the history as a person would say it: "Stroke, leaves, 43 samples". */
#pragma once

typedef struct WrText WrText;

/* Of a command line, in the window's language; added to out. */
void wr_line_words(const char *line, WrText *out);
