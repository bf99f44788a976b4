/* command_table.h - the one table of commands: names, classes, arguments with types, ranges, defaults and help,
   and the functions that carry them out. The parser, the printer, the help, the window's dialogs and the
   tests all go by it: a new command is a row with its arguments and functions in one file, and a line in commands.c.
   Layer 6. */
#pragma once
#include "generate/generator.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrScene WrScene;
typedef struct WrText WrText;

typedef struct WrSession WrSession;
typedef struct WrCall WrCall;

#define WR_BIG_HEIGHT 3.4028234663852886e38 /* the largest float: heights are float32 */
#define WR_ARGS_MAX 64                      /* arguments of one form of a command */
#define WR_LIGHTS_MAX 256                   /* lights of a scene */
#define WR_POINTS_MAX 1000000               /* samples of a stroke */
#define WR_TERMS_MAX 65536                  /* terms of an analytic function */

typedef enum WrCommandClass {
    WR_CLASS_EDIT,    /* changes heights, layers or the selection: undoable, journaled */
    WR_CLASS_SCENE,   /* what pictures show: undoable, journaled, saved with the document */
    WR_CLASS_VIEW,    /* how pictures look at it: no step of the edits, but of a history of its own;
                        journaled, saved with the document */
    WR_CLASS_OUTPUT,  /* writes files: never in a journal, never in a document */
    WR_CLASS_HISTORY, /* goes through what was done: no step of its own, journaled as itself */
    WR_CLASS_COUNT
} WrCommandClass;

/* "edit", "scene", "view", "output", "history" */
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
    const char *name; /* of a positional: how help shows it ("u,v"); NULL ends a list */
    const char *also; /* another name that a line may give it, such as an earlier one; NULL: none */
    WrArgType type;
    bool positional; /* by place; else name=value */
    bool required;
    double low, high; /* closed range of each number (of a size: of each side) */
    bool above;       /* `low` itself is excluded */
    bool whole;       /* whole numbers only (a size always is) */
    bool share; /* whole texels along a side; a number between -1 and 1 is a share of that side */
    int components; /* numbers of a tuple, of each tuple of a list; others: 0 */
    const WrComponent
        *parts; /* [components] ranges of their own instead of low, high; NULL: none */
    unsigned
        counts; /* lists: bit n is set where a tuple may have n numbers; 0: always `components` */
    const char *shape;            /* how it is written: "x,y,z"; NULL: by its type */
    int rows_low, rows_high;      /* lists: how many tuples */
    const char *(*choice)(int i); /* choices: word i, NULL past the last; or else: */
    const char *const
        *words; /* choices: the words, ends with NULL; of a path: those that are no file */
    const double *fallback;               /* numbers that hold where none are given; NULL: none */
    int fallback_rows;                    /* lists: tuples in it */
    const char *fallback_text;            /* the same for choices */
    void (*explain)(int i, WrText *text); /* choices: what word i means, for help; NULL: unsaid */
    bool (*check)(const void *ctx, const char *name, const char *value, WrError *err); /* texts */
    const void *check_ctx;
    bool may_be_empty; /* texts: "" is one */
    const char *unit;  /* "texels", "degrees"; NULL: none */
    const char *help;  /* a few words; of a text also what is allowed */
} WrArgSpec;

/* A command such as `light` has forms (directional, point, clear): its first word names the form, and
   each form has arguments of its own besides those that all share. */
typedef struct WrForm {
    const char *name;
    const char *help;
    WrArgSpec args[WR_ARGS_MAX]; /* ends with name NULL */
} WrForm;

typedef struct WrCommand {
    const char *name; /* NULL ends the table */
    WrCommandClass kind;
    WrCommandClass (*class_of)(int form); /* where it is not that of all forms; or NULL */
    const char *help;                     /* one line */
    const char *details;                  /* sentences for `help NAME`; may be NULL */
    const char *example;                  /* a line that parses */
    const char *form_word; /* what the first word is called ("KIND"); NULL: no forms */
    bool (*form)(int index, WrForm *out); /* the form's row; false past the last */
    bool (*row)(
        WrForm *out); /* the arguments of a command without forms, where another table makes them;
                                 NULL: only args and more */
    const WrArgSpec *args; /* ends with name NULL; shared by all forms; NULL: none */
    const WrArgSpec *more; /* further ones, which other commands have too; or NULL */

    /* Carry out a call whose values are checked against this row. On failure the session may be left
       half changed: the caller puts its snapshot back. */
    bool (*run)(WrSession *session, WrCall *call, WrError *err);
    /* Scene commands and views: the canonical lines that restore this part of a scene, each with its line end. */
    void (*print)(const WrScene *scene, WrText *text);
    bool of_object; /* scene commands: it is about the object at hand, else about all */
} WrCommand;

/* In the order of help; the scene's in the order in which a document keeps them. */
extern const WrCommand *const wr_commands[]; /* ends with NULL */
extern const int wr_command_count;

const WrCommand *wr_command_find(const char *name); /* NULL if there is none */
/* Word i of a choice, NULL past the last (0 <= i <= their number). */
const char *wr_arg_word(const WrArgSpec *spec, int i);
/* The form of that name; its index, or -1. */
int wr_command_form(const WrCommand *command, const char *name, WrForm *out);
/* All arguments of a form (index -1 for a command without forms), shared ones last. Returns how many. */
int wr_command_specs(const WrCommand *command, int form, WrArgSpec out[WR_ARGS_MAX]);
/* Where an argument is not given: "16", "0,0,1", "blinn"; "" if it has no default. */
void wr_arg_fallback_print(const WrArgSpec *spec, WrText *text);
/* What would be right: "a number, 0..1e9 texels", "one of none, blinn, ...". */
void wr_arg_expectation(const WrArgSpec *spec, WrText *text);
