/* fault.h - fault injection: a shared library loaded before the C library that makes the n-th file operation of a
   kind fail, fall short or end the program. Tests link it; other programs load it by LD_PRELOAD, with settings in the
   environment:

     WR_FAULT=KIND,N,MODE,ERRNO    as "write,3,error,28"; kinds and modes as in the tables of fault_shim.c
     WR_FAULT_REPORT=FILE          receives a FaultState: the counts, and the place of the fault

   The reader process for pictures is excluded. */
#pragma once
#include <stdint.h>

typedef enum FaultKind {
    FAULT_OPEN,  /* for writing */
    FAULT_WRITE, /* write, writev, pwrite, copy_file_range, fwrite, fputs */
    FAULT_TRUNCATE,
    FAULT_SYNC, /* fsync, fdatasync */
    FAULT_RENAME,
    FAULT_LINK,
    FAULT_UNLINK,
    FAULT_CLOSE,
    FAULT_KINDS
} FaultKind;

typedef enum FaultMode {
    FAULT_COUNT, /* nothing fails */
    FAULT_ERROR,
    FAULT_SHORT, /* half of it is written; the next call fails */
    FAULT_KILL,  /* before the call */
    FAULT_TORN,  /* after half of it is written */
    /* before a file is created, a link to `victim` is put in its place; only for open */
    FAULT_PLANT,
    FAULT_FLIP,  /* one bit of the data on disk is flipped; success is reported */
    FAULT_DROP,  /* no data is written to disk; success is reported */
    FAULT_STUCK, /* this and all later calls of the kind fail */
    FAULT_MODES
} FaultMode;

/* File that a call concerns. */
typedef enum FaultPlace {
    FAULT_PART,    /* a temporary file that will replace another */
    FAULT_JOURNAL, /* a file in the journal folder, except temporary ones */
    FAULT_MEMORY,  /* a memory file */
    FAULT_FOLDER,
    FAULT_OTHER, /* another regular file */
    FAULT_PLACES
} FaultPlace;

/* Progress of the replacement. */
typedef enum FaultStage {
    FAULT_BEFORE,  /* no partial file exists yet */
    FAULT_WRITING, /* or reading back */
    FAULT_SYNCED,
    FAULT_RENAMED,
    FAULT_STAGES
} FaultStage;

typedef struct FaultState {
    int32_t armed; /* otherwise calls are not counted */
    int32_t kind, mode, error;
    int64_t n; /* from 1 */
    int64_t counts[FAULT_KINDS];
    int64_t seen[FAULT_KINDS][FAULT_PLACES];
    int32_t stage;
    int32_t fell; /* the fault has occurred, and */
    int32_t fell_place, fell_stage;
    int32_t unsynced; /* files with data written since their last sync */
    int32_t careless; /* number of these that were renamed */
    int32_t plants;
    char victim[256], planted[3][400];
} FaultState;

extern const char *const wr_fault_kinds[FAULT_KINDS];
extern const char *const wr_fault_modes[FAULT_MODES];
extern const char *const wr_fault_places[FAULT_PLACES];
extern const char *const wr_fault_stages[FAULT_STAGES];

/* Shared with forked child processes. */
FaultState *wr_fault_state(void);
/* Start counting, and make the n-th call of the kind fail. */
void wr_fault_arm(FaultKind kind, int64_t n, FaultMode mode, int error);
