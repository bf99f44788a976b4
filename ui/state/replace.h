/* replace.h - files that would go are asked about first. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/jobs/files.h"

#include <stdbool.h>

typedef enum WrReplaceKind {
    WR_REPLACE_CHOSEN,  /* the file of a name that was chosen */
    WR_REPLACE_CHANGED, /* the document's own, which another program has written since */
    WR_REPLACE_PRESET,  /* a preset of the user's own */
    WR_REPLACE_KINDS
} WrReplaceKind;

typedef struct WrReplace { /* while it is asked */
    WrReplaceKind kind;
    WrFilePurpose purpose;
    char *path; /* owned */
} WrReplace;

/* If a file stands there, ask whether it may be replaced, and do it then: true. False: there is none. */
bool wr_replace_ask(WrApp *app, WrReplaceKind kind, WrFilePurpose purpose, const char *path);
void wr_dialog_replace(WrApp *app);
