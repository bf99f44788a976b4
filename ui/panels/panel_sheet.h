/* panel_sheet.h - the export sheet: which maps leave, for which program, how they look; and, as long as it is asked for,
   writing them again after each pause of the hand. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"
#include "ui/jobs/sheet_job.h"

typedef struct WrSheetState {
    WrSheetAsk ask;      /* what the sheet holds */
    bool live;           /* write again after each pause of the hand */
    WrJob *look, *write; /* owned; NULL until they are needed */
    WrSheetLook *shown;  /* the newest pictures; owned; NULL: none yet */
    SDL_Texture *pictures[WR_SET_MAPS],
        *greens[2];    /* owned; greens: a bump with green up, and down */
    WrSheetAsk looked; /* what the newest pictures were asked for, of that table */
    uint64_t looked_key;
    WrSetNames names;                      /* of sets, as the sheet was opened */
    uint64_t key, key_table, key_revision; /* of all that maps are made of, at that revision */
    uint64_t written_key;                  /* live: of what was written last */
    uint64_t seen_key;                     /* live: of what is seen now, since */
    double seen_at;
    bool loud; /* what is being written was asked for by the button */
} WrSheetState;

void wr_dialog_sheet(WrApp *app);
void wr_sheet_free(WrApp *app);
/* Is anything being written? Then how far it is, since how many seconds, and for whom. */
bool wr_sheet_writing(const WrApp *app, double *fraction, double *seconds, const char **as);
void wr_sheet_cancel(WrApp *app);

/* ---- sheet_life.c ---- */

WrSheetState *wr_sheet_open(WrApp *app); /* made where it was not there */
void wr_sheet_write(WrApp *app, bool loud);
/* Pictures of what is asked for, where they are not the ones that are there or on their way. */
void wr_sheet_look(WrApp *app);

extern const WrPart wr_part_sheet;
