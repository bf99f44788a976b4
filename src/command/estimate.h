/* estimate.h - the memory that a command will need, counted before it begins from its values and the table's size. How long it
   takes is told while it runs (wr_progress_left).
   Layer 6. */
#pragma once
#include "command/command_line.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrSession WrSession;

typedef struct WrEstimate {
    double bytes;        /* at most at a time, beyond what is held now */
    const char *unknown; /* why nothing is known; NULL: something is */
} WrEstimate;

/* Nothing is changed. False: the line is none that could run. */
bool wr_session_estimate(const WrSession *session, const char *line, WrEstimate *out, WrError *err);
void wr_session_estimate_call(const WrSession *session, const WrCall *call, WrEstimate *out);

/* "300 MB"; "" for less than 64 MB, or where nothing is known. */
#define WR_ESTIMATE_TEXT 24
void wr_estimate_print(const WrEstimate *estimate, char text[WR_ESTIMATE_TEXT]);

/* Has the table a row of this verb's form (NULL: of all), even one that says that nothing is known? */
bool wr_estimate_has(const char *verb, const char *form);
