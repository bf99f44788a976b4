/* command_line.h - parsed and checked values of one command line, and their canonical text.

   A line is   verb value... name=value...   # comment
   Words are separated by spaces or tabs. A value may be in double quotes, in which \" and \\ stand for a quote and a
   backslash. A # outside quotes starts a comment anywhere. Values and names may come in any order. The printer writes
   values first, then names, both in the table's order, and only those that were given. */
#pragma once
#include "command/command_table.h"

#include <stdbool.h>

typedef struct WrSceneParam WrSceneParam;

typedef struct WrArg {
    bool given; /* false: the values are the default, or none */
    int choice; /* choices: index, -1 without value */
    char *text; /* paths, hashes; owned; NULL without value */
    /* [rows][spec.components, 2 for a size, 1 for a number]; owned; NULL without value; numbers
       that a tuple of a list omits are 0 */
    double *numbers;
    unsigned char *counts; /* lists: [rows] count of numbers in each tuple; owned */
    int rows;              /* lists: number of tuples; other types 1, or 0 without value */
    int capacity;          /* allocated rows */
} WrArg;

struct WrCall {
    const WrCommand *command; /* NULL for a blank line or a comment */
    int form;                 /* index, -1 for a command without forms */
    const char *form_name;    /* "" for a command without forms */
    int count;                /* number of arguments */
    WrArgSpec specs[WR_ARGS_MAX];
    WrArg args[WR_ARGS_MAX];
};

/* Parse and check a line. On success the caller owns *call (wr_call_free). A blank line returns a call whose command
 * is NULL. open: required list arguments may be missing (the head of a stroke). Errors contain the command, the
 * argument, its value and the allowed values. */
bool wr_call_parse(const char *line, bool open, WrCall **call, WrError *err);
/* Parse and check the words of a row that need not be in the command table. */
bool wr_call_parse_words(const WrCommand *command, const char *words, WrCall **call, WrError *err);
void wr_call_free(WrCall *call); /* NULL is allowed */

WrCommandClass wr_call_class(const WrCall *call); /* class of the command's form */
/* The call changes which view is shown or which layer is active and nothing else, so that a document loses no work without it. */
bool wr_call_of_views(const WrCall *call);

/* The canonical line, without line end. Parsing it returns the same values; printing those returns the same line. */
void wr_call_print(const WrCall *call, WrText *text);

/* The argument of that name; it must exist in the call's form. */
WrArg *wr_call_arg(const WrCall *call, const char *name);
bool wr_call_given(const WrCall *call, const char *name);
/* The first number of an argument, given or default. */
double wr_call_number(const WrCall *call, const char *name);
/* Index of a choice, given or default. */
int wr_call_choice(const WrCall *call, const char *name);
/* Name of the argument that holds the SHA-256 of the file named by argument `index`: NAME_sha256, or sha256. NULL if
 * that argument names no file, or one that is not read. */
const char *wr_call_hash_argument(const WrCall *call, int index);
/* True if argument `index` is given and is a file name. A preset may be a file name or a bare name. */
bool wr_call_names_file(const WrCall *call, int index);
bool wr_names_preset_file(const char *word); /* true if the word ends in .myb */
/* Set a text argument as if the line contained it. */
void wr_call_set_text(WrCall *call, const char *name, const char *text);
/* Replace the arguments that `words` gives: "size=90". Values without a name replace all values without a name. Checksums
   are forgotten: any value may lead to another file, as another size to another font. On failure the call can only be
   freed. */
bool wr_call_change(WrCall *call, const char *words, WrError *err);
/* Check of a text argument that holds a command line: one that can be the line of a generator layer. */
bool wr_check_layer_line(const void *ctx, const char *name, const char *value, WrError *err);
/* The call of the command line that the call holds in such an argument; NULL: none is given. The caller frees it. */
WrCall *wr_call_inner(const WrCall *call);
/* Visit the call, and the call that it holds, whose text is then written back. */
typedef void WrCallVisit(WrCall *call, void *ctx);
void wr_call_visit(WrCall *call, WrCallVisit *visit, void *ctx);
/* The first file that a layer's line names and that cannot be read: its argument's name (static; "": it has none in lines) and its
   path, appended to `path`; of a font by name, its family. NULL: all can be read, or the line is not known. */
const char *wr_line_missing_file(const char *line, WrText *path);
/* Append a tuple of `count` numbers to a list argument. */
void wr_call_add_row(WrCall *call, const char *name, const double *numbers, int count);

/* Numbers in a row of this argument: 1, 2 for a size, else spec->components. */
int wr_arg_width(const WrArgSpec *spec);
/* Read one value (quotes already removed). *arg must be empty; on failure it stays empty. `where` is the prefix of
   messages: "dab: radius". */
bool wr_arg_parse(const WrArgSpec *spec, const char *where, const char *value, WrArg *arg,
                  WrError *err);
void wr_arg_print(const WrArgSpec *spec, const WrArg *arg, WrText *text);
void wr_arg_fini(WrArg *arg);

/* A word in command syntax: bare if possible, else quoted. */
void wr_text_add_word(WrText *text, const char *word);
/* A path's file name without its ending as such a word, as a layer's name: cut if it is too long. */
void wr_text_add_file_name(WrText *text, const char *path);
/* At most 48 bytes of user text for a message: whole UTF-8 characters, no control characters. */
#define WR_EXCERPT_SIZE 56
const char *wr_excerpt(const char *bytes, char buffer[WR_EXCERPT_SIZE]);

/* Text form of a scene parameter's value in lines and in the window's rows: "off" or "on" for a switch, else the
   numbers separated by commas. values: [3], as wr_scene_param_get fills them. */
void wr_param_text(const WrSceneParam *param, const double *values, WrText *text);

/* Write the error for a verb that no command has. Suggests a command, or the form of one: "did you mean surface
   sphere?" Returns false. */
bool wr_fail_verb(const char *verb, WrError *err);
/* Append a hint to the message of a failed call: the choice word nearest to a file name that does not exist. */
void wr_call_add_hint(const WrCall *call, WrError *err);
