/* estimate.h - how long a command will take and how much memory it will need, before it begins: by counting
   its work from its values and the table's size, never by doing any of it.
   Layer 6. */
#pragma once
#include "command/call.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrSession WrSession;

typedef struct WrEstimate {
    double seconds; /* with the session's threads all busy on it, on the machine of the prices */
    double bytes;   /* at most at a time, beyond what is held now */
    const char *unknown; /* why nothing is known; NULL: something is */
} WrEstimate;

/* Within a factor of 5 mostly: enough to tell moments from minutes. Nothing is changed. False: the line is
   none that could run. */
bool wr_session_estimate(const WrSession *session, const char *line, WrEstimate *out, WrError *err);
void wr_session_estimate_call(const WrSession *session, const WrCall *call, WrEstimate *out);

/* "about 12 s, 300 MB"; "" for what nobody waits for: under half a second and 64 MB, or nothing is known. */
#define WR_ESTIMATE_TEXT 48
void wr_estimate_print(const WrEstimate *estimate, char text[WR_ESTIMATE_TEXT]);

/* Does the table of prices say something, or say that nothing is known, of this verb's form (NULL: of all)? */
bool wr_estimate_has(const char *verb, const char *form);
