/* estimate.h - memory estimate of a command before it runs, computed from its values and the size of the tables. Time
   estimates are made while a command runs (wr_time_left). */
#pragma once
#include "command/command_line.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrSession WrSession;

typedef struct WrEstimate {
    double bytes;        /* peak, beyond the memory in use now */
    const char *unknown; /* reason for a missing estimate; NULL: there is an estimate */
} WrEstimate;

/* Estimate one line; the session is not changed. False if the line is not a valid command. */
bool wr_session_estimate(const WrSession *session, const char *line, WrEstimate *out, WrError *err);
void wr_session_estimate_call(const WrSession *session, const WrCall *call, WrEstimate *out);

/* "300 MB"; "" for less than 64 MB, or without an estimate. */
#define WR_ESTIMATE_TEXT 24
void wr_estimate_print(const WrEstimate *estimate, char text[WR_ESTIMATE_TEXT]);

/* True if the table has a row for this form of the verb (NULL: for all forms), even one without an estimate. */
bool wr_estimate_has(const char *verb, const char *form);
