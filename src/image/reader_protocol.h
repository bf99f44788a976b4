/* reader_protocol.h - protocol between the program and its reader process.
   Private to this module.

   The program starts the reader process once. It sends orders over the control socket, one packet each:
   a WrWireOrder with two descriptors, the file to read and one end of a channel. The process forks; its
   child reads that one file and replies on that channel. If the child ends without a request, the
   process reports that on the channel. Closing the program's end of a channel ends the child; closing
   the control socket ends the process. On a channel: messages of a WrWireHead and `length` bytes. The
   child sends first.

     child:    OPENED parts     FAILED sentence     MEMORY     LIBRARY: send the order again, with `library`
     program:  READ WrWireRead  -> child: DONE, FAILED, MEMORY
               DIGEST WrWireDigest -> child: DIGEST WrHash, FAILED, MEMORY
               TEXT WrWireText  -> child: TEXT (found: the text and a NUL; else nothing)
     process:  DIED WrWireDied

   Other files than images are read at once; there the program sends first:

     program:  ASK (for a font: WrFontOrder and texts, font_internal.h; for a whole mesh: a byte;
               for a drawing: WrSvgRequest)
               -> child: BLOCK bytes, FAILED, MEMORY

   Pixels are transferred in a memory file of the program, sealed against changes of size, which is sent
   with the first READ that needs it. */
#pragma once
#include "base/hash.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_WIRE_VERSION 9
#define WR_WIRE_MAX (512U << 20) /* bytes of a message */

/* Kind of file. */
typedef enum WrWireTask { WR_WIRE_PICTURE, WR_WIRE_MESH, WR_WIRE_FONT, WR_WIRE_SVG } WrWireTask;

typedef struct WrWireOrder {
    uint32_t version; /* WR_WIRE_VERSION */
    uint32_t task;    /* WrWireTask */
    int32_t most;     /* parts */
    uint32_t library; /* 1: the module with OpenImageIO is loaded before the child begins; else 0 */
    uint32_t numbers; /* 1: integers that are measurements are read as numbers; else 0 */
    uint64_t memory;  /* limit of additional memory in bytes; 0: no limit */
    uint32_t seconds; /* processor time for the whole file */
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
    WR_WIRE_DIGEST,
    WR_WIRE_LIBRARY
} WrWireKind;

typedef struct WrWireHead {
    uint32_t kind, length;
} WrWireHead;

typedef struct WrWireRead {
    int32_t part, y, rows, channels;
    uint64_t at;    /* byte offset in the memory file */
    uint64_t bytes; /* size of a memory file sent with this message; 0: the previous one */
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
    int32_t why, number; /* as in WrChildEnd */
} WrWireDied;

/* Sends one message, with a descriptor (fd < 0: none). False when the other end is closed. Never raises
 * SIGPIPE. */
bool wr_wire_send(int channel, WrWireKind kind, const void *bytes, size_t length, int fd);

/* Receives exactly `length` bytes. deadline: by wr_clock_seconds, or <= 0 for none. fd, if not NULL,
 * receives an attached descriptor, or -1. */
typedef enum WrWireGot { WR_WIRE_GOT, WR_WIRE_GONE, WR_WIRE_LATE } WrWireGot;
WrWireGot wr_wire_receive(int channel, void *bytes, size_t length, double deadline, int *fd);
/* Waits until something can be received, without receiving it. */
WrWireGot wr_wire_wait(int channel, double deadline);
