/* Reasons why a replica stops, one bit each, stored per grain. The replica stops at the step in which a bit
   is set; the host reports replica, grain and step. Shared with the host. */
#define STATUS_OVERLAP 1      /* corrected overlap above the scene's limit, or NaN */
#define STATUS_NOT_A_NUMBER 2 /* position or angular velocity is not finite */
#define STATUS_LOST 4         /* centre outside the walls, or more than MAX_DRIFT periods away */
#define STATUS_SLOTS 8        /* more neighbours than slots */
#define STATUS_UNPROBED 16    /* a surface without contact is displaced by more than the probed gap */
