/* command_table.h - the command table: names, classes, arguments with types, ranges, defaults and help, and handlers.
   The parser, the printer, the help, the window's dialogs and the tests all use it. A new command is a row with its
   arguments and functions in one file, and one line in commands.c. */
#pragma once
#include "generate/generator.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrScene WrScene;
typedef struct WrText WrText;

typedef struct WrSession WrSession;
typedef struct WrCall WrCall;

#define WR_BIG_HEIGHT 3.4028234663852886e38 /* largest float: heights are float32 */
#define WR_ARGS_MAX 64                      /* arguments of one form of a command */
#define WR_LIGHTS_MAX 256                   /* lights of a scene */
#define WR_POINTS_MAX 1000000               /* samples of a stroke */
#define WR_TERMS_MAX 65536                  /* terms of an analytic function */

typedef enum WrCommandClass {
    WR_CLASS_EDIT, /* changes heights, layers or the selection: undoable, journaled */
    /* changes the content of pictures: undoable, journaled, saved with the document */
    WR_CLASS_SCENE,
    /* changes the view: no edit step, but a step of the view history; journaled, saved with the
       document */
    WR_CLASS_VIEW,
    /* chooses the layer of later edits: no edit step; journaled, in scripts, saved with the document */
    WR_CLASS_CHOICE,
    WR_CLASS_OUTPUT,  /* writes files: never in a journal, never in a document */
    WR_CLASS_HISTORY, /* moves through the history: no step of its own; journaled as such */
    WR_CLASS_COUNT
} WrCommandClass;

/* "edit", "scene", "view", "choice", "output", "history" */
extern const char *const wr_class_names[WR_CLASS_COUNT];

typedef enum WrArgType {
    WR_ARG_NUMBER, /* 0.5 */
    WR_ARG_SIZE,   /* 512x256: two whole numbers */
    WR_ARG_TUPLE,  /* 0,0,1: `components` numbers */
    WR_ARG_LIST,   /* 0,0;1,0.5: tuples */
    WR_ARG_CHOICE, /* one word of a fixed list */
    WR_ARG_PATH,   /* a file name: any text but line ends */
    WR_ARG_TEXT,   /* any text but line ends that `check` accepts */
    WR_ARG_SHA256, /* 64 hex digits; printed in lower case */
    WR_ARG_NAME,   /* a layer's name: any text but line ends, up to WR_LAYER_NAME_MAX bytes */
    WR_ARG_LAYER,  /* a layer: its number, from 1 at the bottom, or its name */
    WR_ARG_PRESET, /* a brush preset: its name, or a file name that ends in .myb */
    WR_ARG_TYPES
} WrArgType;

extern const char *const wr_arg_type_names[WR_ARG_TYPES]; /* "number", "size", ... */

/* One number of a tuple whose numbers have ranges of their own. */
typedef WrParamPart WrComponent;

typedef struct WrArgSpec {
    const char *name; /* of a positional: its name in help ("u,v"); NULL ends a list */
    const char *also; /* alias accepted in lines, such as a former name; NULL: none */
    WrArgType type;
    bool positional; /* written without a name; else name=value */
    bool required;
    double low, high; /* closed range of each number (of a size: of each side) */
    bool above;       /* `low` itself is excluded */
    bool whole;       /* whole numbers only (a size always is) */
    /* whole texels along a side; a number between -1 and 1 is a fraction of that side */
    bool share;
    bool length; /* lengths such as 10mm; without a unit in millimetres, as which they are stored */
    int components; /* numbers in a tuple, or in each tuple of a list; other types: 0 */
    /* [components] one range for each number, instead of low and high; NULL: none */
    const WrComponent *parts;
    unsigned counts; /* lists: bit n is set if a tuple may have n numbers; 0: always `components` */
    /* syntax shown in help, such as "x,y,z"; NULL: derived from the type */
    const char *shape;
    int rows_low, rows_high;      /* lists: range of the number of tuples */
    const char *(*choice)(int i); /* choices: word i, NULL past the last; alternative to `words` */
    /* choices: the words, NULL-terminated; paths: words that are no file names */
    const char *const *words;
    const double *fallback;               /* default numbers; NULL: none */
    int fallback_rows;                    /* lists: number of default tuples */
    const char *fallback_text;            /* choices: default word */
    void (*explain)(int i, WrText *text); /* choices: meaning of word i, for help; NULL: none */
    /* texts: validation */
    bool (*check)(const void *ctx, const char *name, const char *value, WrError *err);
    const void *check_ctx;
    bool may_be_empty; /* texts: "" is allowed */
    bool several;      /* layers: a list of them, separated by commas */
    const char *unit;  /* "texels", "degrees"; NULL: none */
    const char *help;  /* a few words; for a text also its allowed content */
} WrArgSpec;

/* Variant of a command. The first word of a command such as `light` names the form (directional, point, clear); each
   form has its own arguments besides the shared ones. */
typedef struct WrForm {
    const char *name;
    const char *help;
    WrArgSpec args[WR_ARGS_MAX]; /* the last row has name NULL */
} WrForm;

/* Parts of a command's work that may be computed on a copy of the document in advance (wr_session_run_made). */
typedef enum WrPrework {
    WR_PREWORK_NONE,
    WR_PREWORK_TABLES,   /* the layers' tables are copied; `run` is not called */
    WR_PREWORK_COMPOSITE /* `run` is called; the composite is copied */
} WrPrework;

typedef struct WrCommand {
    const char *name; /* NULL ends the table */
    WrCommandClass kind;
    WrCommandClass (*class_of)(int form); /* class by form, if the forms differ; or NULL */
    const char *help;                     /* one line */
    const char *details;                  /* sentences for `help NAME`; may be NULL */
    const char *example;                  /* a valid line */
    const char *form_word; /* name of the first word in help ("KIND"); NULL: no forms */
    bool (*form)(int index, WrForm *out); /* row of the form; false past the last */
    bool (*row)(
        WrForm *out); /* arguments of a command without forms that are generated from another table;
                         NULL: only args and more */
    const WrArgSpec *args; /* shared by all forms; the last row has name NULL; NULL: none */
    const WrArgSpec *more; /* further arguments, shared with other commands; or NULL */

    /* Carry out a call whose values were checked against this row. On failure the session may be half changed: the
       caller restores its snapshot. */
    bool (*run)(WrSession *session, WrCall *call, WrError *err);
    /* Scene and view commands: print the canonical lines that restore this part of a scene, each with its line
       end. */
    void (*print)(const WrScene *scene, WrText *text);
    /* Print the same lines with the checksum of a file in place of its path, if the checksum is known; NULL: `print`. */
    void (*print_content)(const WrScene *scene, WrText *text);
    bool of_object; /* scene commands: applies to the active object, else to the whole scene */
    /* With several objects the `object` line contains this command's values, so no line of its own is printed. */
    bool in_object;

    /* Read by the session, its journal and recovery. */
    WrPrework prework;
    bool of_variants; /* outputs: <VARIANT> in its texts: it is run for each variant (variants.h) */
    bool links;       /* its layer is a linked copy of another one (linked_copies.c) */
    bool generates;   /* it can be the line of a generator layer (generator_layers.c) */
    bool has_handles; /* the points of such a line are dragged on the canvas with any tool */
    bool streams;     /* an open call may get its samples one by one (wr_session_stroke_begin) */
    bool on_mesh;     /* it paints on the active object's mesh; its samples are x,y,z */
    bool of_views;    /* a history command that changes which view is shown, and nothing else */
    bool after_journal; /* its line is not journaled; the journal starts again after it */
    int steps; /* direction of argument N in the history of edits: -1 back, 1 forward, 0: no such argument */
    bool
        print_end; /* the chosen dials are appended to its line in a saved document (session_picture.c) */
    /* Print the line to run instead if the scene has several objects; returns false if the call is to run as it is;
       or NULL. */
    bool (*of_several)(const WrCall *call, WrText *text);
} WrCommand;

/* Commands in the order of help; scene commands in the order in which a document stores them. */
extern const WrCommand *const wr_commands[]; /* the last entry is NULL */
extern const int wr_command_count;

const WrCommand *wr_command_find(const char *name); /* NULL if there is no such command */
/* Word i of a choice, NULL past the last (0 <= i <= number of words). */
const char *wr_arg_word(const WrArgSpec *spec, int i);
/* Index of the form of that name, or -1; its row goes to *out. */
int wr_command_form(const WrCommand *command, const char *name, WrForm *out);
/* All arguments of a form (index -1 for a command without forms), shared ones last. Returns their number. */
int wr_command_specs(const WrCommand *command, int form, WrArgSpec out[WR_ARGS_MAX]);
/* Default value as text: "16", "0,0,1", "blinn"; "" if there is none. */
void wr_arg_fallback_print(const WrArgSpec *spec, WrText *text);
/* Description of the allowed values: "a number, 0..1e9 texels", "one of none, blinn, ...". */
void wr_arg_expectation(const WrArgSpec *spec, WrText *text);
