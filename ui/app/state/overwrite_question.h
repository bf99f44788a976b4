/* overwrite_question.h - question before an existing file is overwritten. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/jobs/files.h"

#include <stdbool.h>

typedef enum WrReplaceKind {
    WR_REPLACE_CHOSEN,  /* a file chosen in a dialog */
    WR_REPLACE_CHANGED, /* the document's own file, changed by another program */
    WR_REPLACE_PRESET,  /* a preset of the user */
    WR_REPLACE_KINDS
} WrReplaceKind;

typedef struct WrReplace { /* state of the open question */
    WrReplaceKind kind;
    WrFilePurpose purpose;
    char *path;  /* owned */
    char *found; /* the file that exists: path, or that of a variant; owned */
} WrReplace;

/* If the file exists, open the question and do the action after a yes; returns true. False: there is no such file. */
bool wr_replace_confirm(WrApp *app, WrReplaceKind kind, WrFilePurpose purpose, const char *path);
void wr_dialog_replace(WrApp *app);
