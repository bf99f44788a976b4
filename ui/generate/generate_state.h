/* generate_state.h - what the Generate panel holds: the generator in hand and its values. The views show what
   it would make, on a snapshot, while it is `active`; only wr_generate_commit changes the document. All is
   made from the generators' table: none is named here. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"
#include "ui/generate/generate_gallery.h"
#include "ui/tools/tool.h"

#include "base/array.h"
#include "base/error.h"
#include "field/select.h"
#include "generate/generator.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrFontChoice WrFontChoice;
typedef struct WrGallery WrGallery;
typedef struct WrPointer WrPointer;
typedef struct WrText WrText;

#define WR_GENERATE_WAKE 8      /* pictures that a new field takes to get the keyboard, at most */
#define WR_GENERATE_TEXT 4096   /* bytes of a text, a file's name, a list of points */
#define WR_GENERATE_PRESETS 500 /* of the user's own, at most */
#define WR_GENERATE_NAME 64     /* bytes of a preset's name */

typedef struct WrGenerateValue {
    double number[3]; /* as WrParamValue */
    char *text; /* [WR_GENERATE_TEXT], owned: texts, files; points and terms as they are written.
                         NULL for other kinds */
} WrGenerateValue;

typedef struct WrGeneratePreset {
    char *name, *line;            /* owned */
    const WrGenerator *generator; /* NULL: the line is not understood, but kept */
} WrGeneratePreset;

/* Parts of what is drawn on the canvas. */
typedef enum WrPosePart {
    WR_POSE_NONE,
    WR_POSE_PLACE,
    WR_POSE_SIZE,
    WR_POSE_TURN,
    WR_POSE_POINT
} WrPosePart;

typedef struct WrGenerateHand {
    const WrGenerator *generator; /* NULL: none was chosen yet */
    WrGenerateValue value[WR_GENERATOR_PARAMS];
    int blend; /* WrBlend */
    double radius, offset;
    WR_ARRAY(char *) kept; /* lines of generators that were in hand before, owned */

    bool active;                 /* the views show what it would make */
    char *asked;                 /* line that the trial was asked for, owned; NULL: none */
    uint64_t asked_at;           /* the document's revision then */
    double seconds;              /* that its last exact result took; 0: not known */
    const WrGenerator *asked_of; /* whose line that was */
    WrError err;                 /* why there is nothing to be seen; "": there is */
    int blamed; /* the parameter that err is about, by wr_generate_blame; -1: none of them alone */
    const char *blame; /* what err says of it, in err */
    int opened;        /* counts openings: each shows its first value */
    bool blame_seen;   /* the panel said so beside it, in the last picture */
    int focus_text;    /* the text gets the keyboard: for how many pictures that is still tried */
    int asking_file;   /* parameter that a file is being chosen for */

    WR_ARRAY(WrGeneratePreset) presets;
    bool presets_known;
    char name[WR_GENERATE_NAME]; /* of a preset to be saved */
    int preset;                  /* chosen, index; -1: the defaults, -2: none of them */

    WrGallery *gallery;  /* owned; NULL until it is opened */
    WrFontChoice *fonts; /* owned; likewise */

    WrPosePart held; /* by the pointer */
    double first[3], first_number[3];
    bool placed; /* the press put it there */
    int point;   /* of its places, the one that is held; -1: none */
    WrSelectPoint point_first;
} WrGenerateHand;

void wr_generate_new(WrApp *app);
void wr_generate_free(WrApp *app);

/* ---- what is in hand ---- */
/* The generator of an action "generate_FAMILY" or "generate_FAMILY_NAME", or NULL; and its name. */
const WrGenerator *wr_action_generator(const char *name);
#define WR_GENERATE_ACTION 64
void wr_generate_action(const WrGenerator *generator, char name[WR_GENERATE_ACTION]);
/* Open what "generate_FAMILY_NAME" says; see WrActionFamily. */
bool wr_generate_by_name(WrApp *app, const char *name);
/* Take it in hand with the values it last had, choose its tool and its tab, and show what it would make. */
void wr_generate_open(WrApp *app, const WrGenerator *generator);
/* The one that was in hand last, or the first. */
const WrGenerator *wr_generate_last(const WrApp *app);
void wr_generate_open_last(WrApp *app);
/* Take it in hand, nothing more. */
void wr_generate_take(WrApp *app, const WrGenerator *generator);
void wr_generate_defaults(WrApp *app);
/* The values of a command line; a failure becomes a message. */
bool wr_generate_load(WrApp *app, const char *line);
/* The command line that the values make. Only what differs from the defaults is told. */
void wr_generate_line(const WrGenerateHand *hand, WrText *line);
/* The index of the first parameter that is one of `names` (ends with NULL), of that kind, or -1. */
int wr_generate_find(const WrGenerateHand *hand, const char *const *names, WrParamKind kind);
/* The index of what is written: its first text. -1: it writes nothing. */
int wr_generate_written(const WrGenerator *generator);
/* The line of its defaults; what it writes, if anything, is `written`. */
void wr_generate_default_line(const WrGenerator *generator, const char *written, WrText *line);
bool wr_generate_is_default(const WrGenerateHand *hand, int param);
/* Which parameter err is about, and what it says: sets blamed and blame. */
void wr_generate_blame(WrGenerateHand *hand);
/* A text of it; cut where it is too long. */
void wr_generate_set_text(WrGenerateValue *value, const char *text);
void wr_generate_free_values(WrGenerateHand *hand);
/* A value was changed. */
void wr_generate_changed(WrApp *app);
void wr_generate_focus_text(WrApp *app);             /* what is written gets the keyboard */
void wr_generate_file(WrApp *app, const char *path); /* it was chosen for asking_file */

/* ---- what would come of it ---- */
void wr_generate_update(WrApp *app); /* once before each picture */
void wr_generate_commit(WrApp *app);
/* Letters are being written: Ctrl and Enter puts them on the table. */
bool wr_generate_writes(const WrApp *app);
void wr_generate_cancel(WrApp *app); /* nothing is shown any more; the values stay */

/* ---- generate_presets.c: presets.wrinkle in the settings folder, a script of lines with their names as comments
   before them ---- */
void wr_generate_presets_find(WrApp *app); /* reads them at the first call */
bool wr_generate_preset_taken(const WrApp *app, const char *name); /* there is one of that name */
bool wr_generate_preset_save(WrApp *app, const char *name);
bool wr_generate_preset_delete(WrApp *app, int index);

/* ---- panel_generate.c ---- */
void wr_panel_generate(WrApp *app, SDL_Rect room);
void wr_panel_generate_values(WrApp *app); /* panel_generate_values.c */

/* ---- tool_pose.c ---- */

/* ---- pose_points.c: its places, where it has several ---- */
bool wr_pose_points_press(WrApp *app,
                          const WrPointer *at); /* it took the press: there are some now */
void wr_pose_points_drag(WrApp *app, const WrPointer *at);
bool wr_pose_points_marks(const WrApp *app);           /* there are some */
bool wr_pose_points_taken(const WrGenerateHand *hand); /* there may be some */

extern const WrPart wr_part_generate;

extern const WrTool wr_tool_generate;
