package lensprof;

/** The library refused a call or failed. The message names the item and the next step. */
public final class LensprofException extends RuntimeException {
    private static final long serialVersionUID = 1L;

    private final Abi.Status status;

    LensprofException(Abi.Status status, String text) {
        super(text + " (LENSPROF_" + status + ")");
        this.status = status;
    }

    public Abi.Status status() {
        return status;
    }

    /** The error of a call that has no text of its own. */
    static void check(int status, String text) {
        if (status != Abi.Status.OK.value) {
            Abi.Status known = Abi.Status.of(status);
            throw new LensprofException(known != null ? known : Abi.Status.ERROR_INTERNAL, text);
        }
    }

    /** The error of a call with the library's text. */
    static void check(int status, Abi.ErrorText error) {
        check(status, Key.text(error.text));
    }

    /** The error of a call that read a blob of so many bytes. */
    static void checkBlob(int status, int bytes, String text) {
        String item = "profile blob of " + bytes + " bytes: ";
        if (status == Abi.Status.ERROR_LAYOUT.value) {
            check(status, item + "written by a newer lensprof; update this library");
        } else if (status == Abi.Status.ERROR_CORRUPT.value || (status != Abi.Status.OK.value && bytes == 0)) {
            check(Abi.Status.ERROR_CORRUPT.value, item + "not a blob, or damaged; export it again");
        }
        check(status, text);
    }
}
