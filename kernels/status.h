/* Why a replica stops. One bit a cause, kept per grain with the step at which it was first set; the
   host names replica, grain and step. Shared by host and device. */
#define STATUS_OVERLAP 1      /* corrected overlap beyond the stated limit: no static solution */
#define STATUS_NOT_A_NUMBER 2 /* position or velocity not finite */
#define STATUS_LOST 4         /* centre outside the box */
#define STATUS_SLOTS 8        /* more neighbours than slots */
#define STATUS_UNPROBED 16    /* a surface is displaced as far as the probed gap: contacts may be missed */
