/* generate_state.h - state of the Generate panel: the current generator and its values. While it is `active`, the
   views show its preview on a snapshot; only wr_generate_commit changes the document. Everything derives from the
   table of generators; no generator is named here. */
#pragma once
#include "ui/app/jobs/edit_preview.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/panels/generate/generate_presets.h"
#include "ui/canvas/tools/tool.h"

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

#define WR_GENERATE_WAKE 8      /* frames in which focusing a new field is tried */
#define WR_GENERATE_TEXT 4096   /* size limit in bytes of a text, a file name, a list of points */
#define WR_GENERATE_PRESETS 600 /* limit of presets */
#define WR_GENERATE_NAME 64     /* size limit of a preset's name in bytes */

typedef struct WrGenerateValue {
    double number[3]; /* as WrParamValue */
    /* [WR_GENERATE_TEXT], owned: texts, file names; points and terms in command syntax. NULL for
       other kinds */
    char *text;
} WrGenerateValue;

typedef struct WrGeneratePreset {
    char *name, *line;            /* owned */
    const WrGenerator *generator; /* NULL: an unknown line, which is kept */
    char
        *words; /* owned; for the search, of presets that ship with the program; NULL: the user's */
} WrGeneratePreset;

/* Handles on the canvas. */
typedef enum WrPosePart {
    WR_POSE_NONE,
    WR_POSE_PLACE,
    WR_POSE_SIZE,
    WR_POSE_TURN,
    WR_POSE_POINT
} WrPosePart;

typedef struct WrGenerateState {
    const WrGenerator *generator; /* NULL: none chosen yet */
    WrGenerateValue value[WR_GENERATOR_PARAMS];
    int blend; /* WrBlend */
    double radius, offset;
    WR_ARRAY(char *) kept; /* lines of previously used generators, owned */

    bool active;       /* the views show the preview */
    int layer;         /* index of the generator layer whose values are edited; -1: none */
    bool into_active;  /* the result goes into the active layer, not to a new one */
    char *asked;       /* line of the requested preview, owned; NULL: none */
    uint64_t asked_at; /* the document's revision at the request */
    double seconds;    /* duration of its last exact result; 0: unknown */
    const WrGenerator *asked_of; /* generator of that line */
    WrLineTarget asked_into;
    WrError err; /* reason for a missing preview; "": there is one */
    /* index of the parameter that err is about (wr_generate_blame); -1: no single one */
    int blamed;
    size_t blame;    /* bytes of err.text before the part about the parameter */
    int opened;      /* count of openings: each scrolls to the first value */
    int focus_text;  /* remaining frames in which focusing the text field is tried */
    int asking_file; /* index of the parameter whose file is being chosen */

    WR_ARRAY(WrGeneratePreset) presets;
    bool presets_known;
    char name[WR_GENERATE_NAME]; /* name of a new preset */
    int preset;                  /* index of the chosen preset; -1: the defaults, -2: none */

    WrGallery *gallery;  /* owned; NULL until it is opened */
    WrFontChoice *fonts; /* owned; NULL until it is opened */

    WrPosePart held; /* handle being dragged */
    double first[3], first_number[3];
    bool placed; /* the press placed the object there */
    int point;   /* index of the dragged point, or of the last one; -1: none */
    WrSelectPoint point_first;
} WrGenerateState;

void wr_generate_new(WrApp *app);
void wr_generate_free(WrApp *app);

/* ---- current generator ---- */
/* The generator of an action "generate_FAMILY" or "generate_FAMILY_NAME", or NULL; and its name. */
const WrGenerator *wr_action_generator(const char *name);
#define WR_GENERATE_ACTION 64
void wr_generate_action(const WrGenerator *generator, char name[WR_GENERATE_ACTION]);
/* Open the generator of "generate_FAMILY_NAME"; see WrActionFamily. */
bool wr_generate_tab_of_action(WrApp *app, const char *name);
/* Choose the generator with its last values, its tool and its tab, and start the preview. */
void wr_generate_open(WrApp *app, const WrGenerator *generator);
/* The last used generator, or the first. */
const WrGenerator *wr_generate_last(const WrApp *app);
void wr_generate_open_last(WrApp *app);
/* Open the generator of generator layer `index`, with its values; they replace the layer's when applied. */
void wr_generate_edit_layer(WrApp *app, int index);
/* Choose the generator without preview, tool and tab. */
void wr_generate_take(WrApp *app, const WrGenerator *generator);
void wr_generate_defaults(WrApp *app);
/* Load the values of a command line; a failure becomes a message. */
bool wr_generate_load(WrApp *app, const char *line);
/* The command line of the values; defaults are omitted. */
void wr_generate_line(const WrGenerateState *hand, WrText *line);
/* Index of the first parameter of that kind whose name is in `names` (NULL-terminated), or -1. */
int wr_generate_find(const WrGenerateState *hand, const char *const *names, WrParamKind kind);
/* Index of the written text: the first text parameter. -1: none. */
int wr_generate_written(const WrGenerator *generator);
/* The line of its defaults, with `written` as its text, if any. */
void wr_generate_default_line(const WrGenerator *generator, const char *written, WrText *line);
bool wr_generate_param_is_default(const WrGenerateState *hand, int param);
/* Find the parameter that err is about: sets blamed and blame. */
void wr_generate_blame(WrGenerateState *hand);
/* Set a text value, truncated if too long. */
void wr_generate_set_text(WrGenerateValue *value, const char *text);
/* Destination of the result. */
WrLineTarget wr_generate_target(const WrGenerateState *hand);
/* To be called after a change of a value. */
void wr_generate_changed(WrApp *app);
void wr_generate_focus_text(WrApp *app);             /* give the keyboard focus to the text field */
void wr_generate_file(WrApp *app, const char *path); /* file chosen for asking_file */

void wr_generate_commit(WrApp *app);
/* Adds a word to a command: the automatic name of a new layer of that line, "Text: Hello", then "Text: Hello 2" and so on. */
void wr_generate_add_name(const WrApp *app, const char *line, WrText *command);
/* Adds " name=" with the new line's name if layer `index` still has the automatic name of its present line. */
void wr_generate_follow_name(const WrApp *app, int index, const char *line, WrText *command);
/* True while a text is typed: Ctrl+Enter then applies it. */
bool wr_generate_writes(const WrApp *app);
void wr_generate_cancel(WrApp *app); /* stop the preview; the values stay */

/* ---- generate_presets.c: presets.wrinkle in the settings folder, a script of lines with their names as comments
   before them ---- */
void wr_generate_presets_forget(WrGenerateState *hand); /* frees them */
void wr_generate_presets_find(WrApp *app);              /* loads them at the first call */
bool wr_generate_preset_taken(const WrApp *app, const char *name); /* true if that name exists */
bool wr_generate_preset_save(WrApp *app, const char *name);
bool wr_generate_preset_delete(WrApp *app, int index);
void wr_generate_preset_open(WrApp *app, int index); /* choose its generator with its values */
SDL_Texture *wr_generate_preset_picture(WrApp *app, int index, int side); /* as wr_thumb */

/* ---- panel_generate.c ---- */
void wr_panel_generate(WrApp *app, SDL_Rect room);
void wr_panel_generate_values(WrApp *app); /* its rows */

/* ---- tool_pose.c ---- */

/* ---- points of generators with several positions ---- */
/* handled: the generator has points now */

extern const WrPart wr_part_generate;

extern const WrTool wr_tool_generate;
