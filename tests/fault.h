/* fault.h - a shared library that comes before the C library and lets a call that changes files fail, fall
   short or end the program: the n-th one of a kind. Tests link it; any program takes it by LD_PRELOAD, with its
   orders in the environment:

     WR_FAULT=KIND,N,MODE,ERRNO    as "write,3,error,28"; kinds and modes as in the tables of fault_shim.c
     WR_FAULT_REPORT=FILE          takes a FaultState: what was counted, and where the fault fell

   The process that reads pictures for the program is left alone. */
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
    FAULT_SHORT, /* half of it is written; the next one fails */
    FAULT_KILL,  /* before the call */
    FAULT_TORN,  /* when half of it is written */
    FAULT_PLANT, /* before a file is created somebody puts a link to `victim` in its place; open alone */
    FAULT_FLIP,  /* one bit of what is written to the disk is another there; success is reported */
    FAULT_DROP,  /* nothing is written to the disk; success is reported */
    FAULT_STUCK, /* it fails, and so does every later call of the kind */
    FAULT_MODES
} FaultMode;

/* What a call is about. */
typedef enum FaultPlace {
    FAULT_PART,    /* a file being written that is to replace another */
    FAULT_JOURNAL, /* what lies in the folder of journals, but for such a file */
    FAULT_MEMORY,  /* a memory file */
    FAULT_FOLDER,
    FAULT_OTHER, /* another regular file */
    FAULT_PLACES
} FaultPlace;

/* How far the replacement had come. */
typedef enum FaultStage {
    FAULT_BEFORE,  /* there is no file of half the way yet */
    FAULT_WRITING, /* or reading back */
    FAULT_SYNCED,
    FAULT_RENAMED,
    FAULT_STAGES
} FaultStage;

typedef struct FaultState {
    int32_t armed; /* else calls pass by uncounted */
    int32_t kind, mode, error;
    int64_t n; /* from 1 */
    int64_t counts[FAULT_KINDS];
    int64_t seen[FAULT_KINDS][FAULT_PLACES];
    int32_t stage;
    int32_t fell; /* the fault has come, and */
    int32_t fell_place, fell_stage;
    int32_t unsynced; /* files that hold what was written since they were synced last */
    int32_t careless; /* of these, how many were given another name */
    int32_t plants;
    char victim[256], planted[3][400];
} FaultState;

extern const char *const wr_fault_kinds[FAULT_KINDS];
extern const char *const wr_fault_modes[FAULT_MODES];
extern const char *const wr_fault_places[FAULT_PLACES];
extern const char *const wr_fault_stages[FAULT_STAGES];

/* Shared with forked copies of the process. */
FaultState *wr_fault_state(void);
/* Begin to count, and let the n-th call of the kind go wrong. */
void wr_fault_arm(FaultKind kind, int64_t n, FaultMode mode, int error);
