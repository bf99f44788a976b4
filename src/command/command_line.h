/* command_line.h - one command line as parsed and checked values, and back as canonical text.
   Layer 6.

   A line is   verb value... name=value...   # comment
   Words are parted by spaces or tabs. A value may be in double quotes, in which \" and \\ stand for a
   quote and a backslash; a # outside quotes starts a comment wherever it stands. Values and names may
   come in any order; the printer puts values first, then names, both in the table's order, and only those
   that were given. */
#pragma once
#include "command/command_table.h"

#include <stdbool.h>

typedef struct WrArg {
    bool given;      /* false: the values are the default, or none */
    int choice;      /* choices: index, -1 without value */
    char *text;      /* paths, hashes; owned; NULL without value */
    double *numbers; /* [rows][spec.components or 2 (size) or 1 (number)], owned; NULL without;
                              numbers that a tuple of a list leaves out are 0 */
    unsigned char *counts; /* lists: [rows] how many numbers each tuple has; owned */
    int rows;              /* lists: tuples; others 1, or 0 without value */
    int capacity;          /* rows allocated */
} WrArg;

struct WrCall {
    const WrCommand *command; /* NULL: a blank line or a comment */
    int form;                 /* index, -1 for a command without forms */
    const char *form_name;    /* "" without forms */
    int count;                /* arguments */
    WrArgSpec specs[WR_ARGS_MAX];
    WrArg args[WR_ARGS_MAX];
};

/* Parse and check a line. On success *call is the caller's (wr_call_free); a blank line gives a call
 * whose command is NULL. open: required list arguments may be missing (the head of a stroke).
 * Errors name the command, the argument, its value and what would be right. */
bool wr_call_parse(const char *line, bool open, WrCall **call, WrError *err);
void wr_call_free(WrCall *call); /* NULL is fine */

WrCommandClass wr_call_class(const WrCall *call); /* of its command, in its form */

/* The canonical line, without line end. Parsing it gives the same values; printing those the same line. */
void wr_call_print(const WrCall *call, WrText *text);

/* The argument of that name; it must exist in the call's form. */
WrArg *wr_call_arg(const WrCall *call, const char *name);
bool wr_call_given(const WrCall *call, const char *name);
/* The first number of an argument: given or default. */
double wr_call_number(const WrCall *call, const char *name);
/* A choice's index, given or default. */
int wr_call_choice(const WrCall *call, const char *name);
/* Three numbers of a tuple. */
/* Where the line gives a value, take it. */
/* The name of the argument that holds the SHA-256 of the file that argument `index` names: NAME_sha256, or
 * sha256. NULL if it names none, or one that is not read. */
const char *wr_call_hash_name(const WrCall *call, int index);
/* Is argument `index` given, and a file's name? A preset may be one or not. */
bool wr_call_names_file(const WrCall *call, int index);
bool wr_names_preset_file(const char *word); /* it ends in .myb */
/* Set a text argument as if the line had given it. */
void wr_call_set_text(WrCall *call, const char *name, const char *text);
/* Append a tuple of `count` numbers to a list argument. */
void wr_call_add_row(WrCall *call, const char *name, const double *numbers, int count);

/* How many numbers a row of this argument has: 1, 2 for a size, else spec->components. */
int wr_arg_width(const WrArgSpec *spec);
/* Read one value (no quotes left). *arg must be empty; on failure it stays so. `where` is put in front
   of messages: "dab: radius". */
bool wr_arg_parse(const WrArgSpec *spec, const char *where, const char *value, WrArg *arg,
                  WrError *err);
void wr_arg_print(const WrArgSpec *spec, const WrArg *arg, WrText *text);
void wr_arg_fini(WrArg *arg);

/* A word as the language writes it: bare where it needs no quotes, else quoted. */
void wr_text_add_word(WrText *text, const char *word);
/* At most 48 bytes of a user's text for a message: whole UTF-8 characters, no control characters. */
#define WR_EXCERPT_SIZE 56
const char *wr_excerpt(const char *bytes, char buffer[WR_EXCERPT_SIZE]);
