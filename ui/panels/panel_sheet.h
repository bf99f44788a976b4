/* panel_sheet.h - export sheet: choice of a set of maps, their pictures and files; optionally live export after each
   pause in editing. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/app/jobs/sheet_job.h"

typedef struct WrSheetState {
    WrSheetRequest ask; /* settings of the sheet */
    int material; /* which material files: a row of material_choices; not stored in the document */
    bool live;    /* live export: write again after each pause in editing */
    WrJob *look, *write; /* owned; NULL until needed */
    WrSheetLook *shown;  /* the newest pictures; owned; NULL: none yet */
    SDL_Texture *pictures[WR_MAP_SET_ENTRIES_MAX],
        *greens[2];        /* owned; greens: pictures of a bump with green up and down */
    WrSheetRequest looked; /* request of the newest pictures */
    uint64_t looked_key;
    WrMapSetNames names;                   /* names of sets when the sheet was opened */
    uint64_t key, key_table, key_revision; /* hashes of all inputs of the maps at that revision */
    uint64_t written_key;                  /* live: key of the last written files */
    /* live: key of the present state, and the time of its first appearance */
    uint64_t seen_key;
    double seen_at;
    double pause; /* live: seconds from the last change to the writing */
    bool loud;    /* the running export was started by the button */
} WrSheetState;

void wr_dialog_sheet(WrApp *app);
void wr_sheet_free(WrApp *app);
/* True while files are written; its progress, elapsed seconds, and target program. */
bool wr_sheet_writing(const WrApp *app, double *fraction, double *seconds, const char **as);
void wr_sheet_cancel(WrApp *app);

extern const WrPart wr_part_sheet;
