package lensprof;

import com.sun.jna.Library;
import com.sun.jna.Native;
import java.util.Arrays;
import java.util.Map;

/** The shared library: the file named by the environment variable LENSPROF_LIBRARY, else as the system finds it. */
public final class Lensprof {
    /** The functions of the C interface. */
    static final Abi.Functions LIBRARY = load();

    private Lensprof() {
    }

    /** Version of the library, e.g. "0.3.0". */
    public static String version() {
        return LIBRARY.lensprof_version();
    }

    private static Abi.Functions load() {
        String named = System.getenv("LENSPROF_LIBRARY");
        String name = named != null && !named.isEmpty() ? named : defaultName();
        Abi.Functions library;
        try {
            library = Native.load(name, Abi.Functions.class, Map.of(Library.OPTION_STRING_ENCODING, "UTF-8"));
        } catch (UnsatisfiedLinkError error) {
            throw new LensprofException(Abi.Status.ERROR_READ, name
                + ": the lensprof library cannot be loaded; install it, or set LENSPROF_LIBRARY to its file");
        }
        checkVersion(library.lensprof_version(), name);
        return library;
    }

    private static String defaultName() {
        return System.getProperty("os.name").equals("Linux") ? "liblensprof.so.0.3" : "lensprof";
    }

    /** While the major version is 0, structures may change with the minor one. */
    private static void checkVersion(String version, String name) {
        String[] library = version.split("\\."), headers = Abi.VERSION.split("\\.");
        if (library.length < 2 || !Arrays.equals(library, 0, 2, headers, 0, 2)) {
            throw new LensprofException(Abi.Status.ERROR_UNSUPPORTED, name + ": is lensprof " + version
                + ", but this package is for " + Abi.VERSION + "; install the two together");
        }
    }
}
