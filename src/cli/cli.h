/* cli.h - the command line: one struct of parsed options, one function for each subcommand.

   Results go to standard output, notes and errors to standard error. Exit status: 0 done; 1 failed, with one message
   that begins "wrinkle: "; 2 error in the shell line itself (unknown subcommand or option, missing value); 130
   interrupted. */
#pragma once
#include <stdbool.h>

typedef struct WrDoc WrDoc;
typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;
typedef struct WrReceipt WrReceipt;
typedef struct WrSession WrSession;
typedef struct WrText WrText;

#define WR_EXIT_DONE 0
#define WR_EXIT_FAILED 1
#define WR_EXIT_USAGE 2
#define WR_EXIT_INTERRUPTED 130

typedef struct WrCli WrCli;

typedef struct WrSubcommand {
    const char *name;
    const char *usage;   /* "render [FILE] -o OUT ..." */
    const char *help;    /* one line */
    unsigned options;    /* bits 1 << WrOption of the accepted options, besides the common ones */
    const char *details; /* for --help; may be NULL */
    int (*run)(const WrCli *cli);
} WrSubcommand;

/* The parsed shell line. All strings are borrowed from argv. */
struct WrCli {
    const WrSubcommand *command;
    bool help;          /* -h, --help */
    bool version;       /* --version */
    const char *file;   /* NULL: none */
    const char **files; /* WR_OPTION_FILES: all of them, file being the first; else empty */
    int file_count;
    const char *
        *words; /* export: name=value; help: the verb; bench: all words and all its own options */
    int word_count;
    const char **dos; /* --do, in order */
    int do_count;
    const char **ats; /* --at, in order */
    int at_count;
    const char *noise;       /* --noise: a command line; NULL: none */
    int threads;             /* 0: one per processor */
    const char *isa;         /* NULL: auto */
    const char *out;         /* -o */
    const char *shown;       /* name of that file in reports; NULL: its own */
    const char *format;      /* --format; NULL: not given */
    int jobs;                /* -j; 0: not given */
    const char *coding;      /* --coding */
    const char *kind;        /* --as */
    bool watch;              /* --watch */
    const char *live;        /* --live; NULL: not given */
    bool sized;              /* --size was given */
    int width, height;       /* default 512x512 */
    bool banded;             /* --rows was given */
    int first_row, last_row; /* of --rows, from the top */
    bool framed;             /* --frames was given */
    int first, last;         /* of --frames */
    int of;                  /* --of; 0: not given */
    double fps;              /* --fps; 0: not given */
    bool looped;             /* --loop was given */
    int loop;
    bool missing;           /* --missing */
    double memory;          /* --memory, MB; 0: not given */
    bool turned;            /* --turn was given */
    double turn_deg;        /* degrees per frame */
    int face;               /* --face */
    bool full;              /* --full */
    const char *completion; /* --completion; NULL: none */
    bool json;
    const char *sheet;      /* --sheet */
    const char *thumbnails; /* --thumbnails */
    const char *collection; /* --collection */
    bool settings;          /* --settings */
    const char *axis;       /* --axis */
    int runs;               /* --runs; 0: not given */
    double budget;          /* --budget, seconds; 0: none */
    const char *csv;        /* --csv */
    const char **plots;     /* --plot, in order */
    int plot_count;
    const char *differences; /* --differences */
    const char **tolerances; /* --tolerance, in order */
    int tolerance_count;
    bool hard_cases; /* --hard-cases */
    bool illusion;   /* --illusion */
    bool beyond;     /* --beyond */
    bool script;     /* --script */
    bool in_place;   /* --in-place */
    bool markdown;   /* --markdown */
    bool measure;    /* --measure */
    bool layers;     /* --layers */
    const char *map; /* --map */

    char **argv;                /* the shell line, for another program */
    WrPool *pool;               /* made by main; owned by it */
    const volatile int *cancel; /* set by an interrupt */
    bool *unprinted; /* becomes true where a receipt could not be printed; NULL: it is not kept */
};

/* Default side of accuracy's pictures in pixels: the reference then takes seconds, not minutes. */
#define WR_ACCURACY_SIDE 256

typedef enum WrOption {
    WR_OPTION_OUT,
    WR_OPTION_AS,   /* --as, --watch */
    WR_OPTION_LIVE, /* --live, --as of its maps */
    WR_OPTION_SIZE,
    WR_OPTION_FULL,
    WR_OPTION_RENDER, /* --rows, --frames, --of, --turn, --fps, --loop, --missing, --memory */
    WR_OPTION_AT,
    WR_OPTION_NOISE,
    WR_OPTION_FACE,
    WR_OPTION_JSON,
    WR_OPTION_ACCURACY,  /* --axis, --runs, --budget, --csv, --plot, --differences,
                            --tolerance, --hard-cases, --illusion */
    WR_OPTION_RECOVER,   /* --beyond, --script, --in-place */
    WR_OPTION_SHEET,     /* --sheet, --thumbnails, --collection, --settings */
    WR_OPTION_MARKDOWN,  /* --markdown */
    WR_OPTION_EXPLAIN,   /* --measure, --layers */
    WR_OPTION_MAP,       /* --map */
    WR_OPTION_CHECK,     /* --as, of pictures */
    WR_OPTION_FORMAT,    /* --format */
    WR_OPTION_FILES,     /* -j, --jobs; accepts several files */
    WR_OPTION_ALL_WORDS, /* no option: accepts any number of words */
    WR_OPTION_OWN,       /* no option: checks unknown options itself, as words */
    WR_OPTION_COMMON     /* of every subcommand */
} WrOption;

/* the last row has name NULL; the first is the default */
extern const WrSubcommand wr_subcommands[];
const WrSubcommand *wr_subcommand_find(const char *name); /* NULL if there is no such subcommand */

/* Parse the shell line. The caller frees the arrays in *cli (wr_cli_fini). On failure *status is 1 or 2 and err holds
 * the message. */
bool wr_cli_parse(int argc, char **argv, WrCli *cli, int *status, WrError *err);
void wr_cli_fini(WrCli *cli);
/* Help of one subcommand with its options; of the program if command is NULL. */
void wr_cli_help(const WrSubcommand *command, WrText *text);
/* Markdown tables: every subcommand with its options; the effects that a plan may skip; the sets of maps. */
/* Option i of a subcommand, or of the common ones: its name, other name, value and help (NULL: none). False past the
 * last. */
bool wr_cli_option(const WrSubcommand *command, bool common, int i, const char *out[4]);

/* A session with FILE loaded (an empty document without one) after every --do line. outputs: perform output commands
 * among the --do lines. The caller owns it; NULL and an error on failure. */
WrSession *wr_cli_load(const WrCli *cli, bool outputs, WrError *err);
const char *wr_cli_file_name(const WrCli *cli); /* FILE without its folder; "" if none is named */
/* Load FILE, if one is named. */
bool wr_cli_open(const WrCli *cli, WrSession *session, WrError *err);
/* The subcommand's document with the options of the line; the caller frees it. NULL and an error: an --isa that does not
   exist or that this processor lacks. outputs: as in WrSessionOptions */
WrDoc *wr_cli_doc(const WrCli *cli, bool outputs, WrError *err);
/* An empty session with notes to standard error. */
WrSession *wr_cli_session(const WrCli *cli, bool outputs, WrError *err);
/* True if the word is a kind of export or a set. False with an error that suggests one. */
bool wr_cli_check_kind(const char *name, WrError *err);
/* Index of a word in a list. False with an error that names the option and suggests a word: "--as hieght: ..." */
bool wr_cli_find_word(const char *option, const char *word,
                      const char *(*list)(const void *ctx, int i), const void *ctx, int *place,
                      WrError *err);
bool wr_cli_run_dos(const WrCli *cli, WrSession *session, WrError *err);

/* Print "wrinkle: MESSAGE" to standard error. Returns status, or 130 after an interrupt. */
int wr_cli_fail(const WrCli *cli, int status, const WrError *err);
/* Print "wrinkle: note: TEXT" to standard error. */
void wr_cli_note(const char *text);
/* Print the receipts of `--json`, or else the text, to standard output; to standard error if the file itself goes to
   standard output. Returns 0, or 1 with a message. */
int wr_cli_report(const WrCli *cli, const WrText *text);
/* Append a file's receipt (export/receipt.h), with the names of the line. */
bool wr_cli_add_receipt(const WrCli *cli, const WrReceipt *receipt, WrText *text, WrError *err);
/* True if the output is standard output: "-" or "/dev/stdout". */
bool wr_cli_to_stdout(const WrCli *cli);
/* Run `work` with a temporary file of that ending as its output, then write the file's bytes to standard output.
   Returns an exit status. */
int wr_cli_pipe(const WrCli *cli, const char *ending, int (*work)(const WrCli *cli));
/* Write a result to standard output at once. Returns 0, or 1 with a message on failure. */
int wr_cli_print(const WrCli *cli, const WrText *text);

/* Progress line on standard error, if that is a terminal. */
void wr_cli_progress_begin(WrProgress *progress); /* starts reporting it */
void wr_cli_progress_resume(void);                /* begins another piece of work */
void wr_cli_progress_clear(void);                 /* clears the line until the next report */
void wr_cli_progress_stop(void);                  /* clears the line and stops reporting */

int wr_cli_paint(const WrCli *cli);
int wr_cli_run(const WrCli *cli);
int wr_cli_render(const WrCli *cli);
int wr_cli_export(const WrCli *cli);
int wr_cli_check(const WrCli *cli);
int wr_cli_inspect(const WrCli *cli);
int wr_cli_explain(const WrCli *cli);
int wr_cli_accuracy(const WrCli *cli);
int wr_cli_recover(const WrCli *cli);
int wr_cli_print_completion(const WrCli *cli); /* of help --completion */
int wr_cli_brushes(const WrCli *cli);
/* The measurements of `bench`, which parses its own options from words, and of `accuracy --tolerance`: in wrinkle both
 * start the program wrinkle-bench, which has them (tests/bench/). */
int wr_cli_bench(const WrCli *cli);
int wr_cli_contest(const WrCli *cli);
int wr_cli_help_command(const WrCli *cli);
