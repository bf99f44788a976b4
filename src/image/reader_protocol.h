/* reader_protocol.h - what the program and its reader process say to each other.
   Private to this module.

   The program starts the reader process once. Orders go to it over the control socket, one packet each: a
   WrWireOrder with two descriptors, the file to read and one end of a channel. The process forks; its
   child reads that one file and answers on that one channel, and when it dies without having been told
   to, the process says so there. Closing the program's end of a channel ends the child; closing the
   control socket ends the process.

   On a channel: messages of a WrWireHead and `length` bytes. The child speaks first.

     child:    OPENED parts     FAILED sentence     MEMORY
     program:  READ WrWireRead  -> child: DONE, FAILED, MEMORY
               DIGEST WrWireDigest -> child: DIGEST WrHash, FAILED, MEMORY
               TEXT WrWireText  -> child: TEXT (found: the text and a NUL; else nothing)
     process:  DIED WrWireDied

   Files of other tasks than pictures are read in one go; there the program speaks first:

     program:  ASK (of a font: WrFontOrder and texts, font_internal.h; of a whole mesh: a byte)  -> child: BLOCK bytes, FAILED, MEMORY

   Pixels go through a memory file of the program's, sealed against change of size, that travels with the
   first READ that needs it. */
#pragma once
#include "base/hash.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_WIRE_VERSION 7
#define WR_WIRE_MAX (512U << 20) /* bytes of a message */

/* What kind of file. */
typedef enum WrWireTask { WR_WIRE_PICTURE, WR_WIRE_MESH, WR_WIRE_FONT } WrWireTask;

typedef struct WrWireOrder {
    uint32_t version; /* WR_WIRE_VERSION */
    uint32_t task;    /* WrWireTask */
    int32_t most;     /* parts */
    uint32_t numbers; /* 1: integers that are measurements are read as numbers; else 0 */
    uint64_t memory;  /* bytes that reading may take beyond what the process has; 0: no limit */
    uint32_t seconds; /* of processor time, for the whole file */
    char ending[16];
} WrWireOrder;

typedef enum WrWireKind {
    WR_WIRE_OPENED = 1,
    WR_WIRE_FAILED,
    WR_WIRE_MEMORY,
    WR_WIRE_READ,
    WR_WIRE_DONE,
    WR_WIRE_TEXT,
    WR_WIRE_DIED,
    WR_WIRE_ASK,
    WR_WIRE_BLOCK,
    WR_WIRE_DIGEST
} WrWireKind;

typedef struct WrWireHead {
    uint32_t kind, length;
} WrWireHead;

typedef struct WrWireRead {
    int32_t part, y, rows, channels;
    uint64_t at;    /* bytes into the memory file */
    uint64_t bytes; /* of a memory file that comes with this message; 0: the one sent before */
} WrWireRead;

typedef struct WrWireDigest {
    int32_t part, y, rows, channels;
    WrHash digest; /* of the rows above */
} WrWireDigest;

typedef struct WrWireText {
    int32_t part;
    char name[124]; /* ends in NUL */
} WrWireText;

typedef struct WrWireDied {
    int32_t why, number; /* as WrChildEnd has them */
} WrWireDied;

/* Send one message, with a descriptor (fd < 0: none). False when the other end is gone. Never raises
 * SIGPIPE. */
bool wr_wire_send(int channel, WrWireKind kind, const void *bytes, size_t length, int fd);

/* Receive exactly `length` bytes. deadline: by wr_clock_seconds, or <= 0 to wait for ever. fd, if not
 * NULL, takes a descriptor that came along, or -1. */
typedef enum WrWireGot { WR_WIRE_GOT, WR_WIRE_GONE, WR_WIRE_LATE } WrWireGot;
WrWireGot wr_wire_receive(int channel, void *bytes, size_t length, double deadline, int *fd);
/* Wait until something is there to be received, without taking it. */
WrWireGot wr_wire_wait(int channel, double deadline);
