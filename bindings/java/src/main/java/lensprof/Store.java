package lensprof;

import com.sun.jna.Pointer;
import com.sun.jna.ptr.PointerByReference;

/** An open profile database, which is only read; for try-with-resources. Threads that use it wait for each other. */
public final class Store implements AutoCloseable {
    private Pointer store;

    /**
     * The answer of a lookup.
     *
     * @param exact the answer is a stored profile, unchanged
     * @param profiles stored profiles used for the falloff
     * @param sigma standard error of the falloff in the corner, or Abi.UNKNOWN
     * @param reason warnings, as whole sentences
     */
    public record Found(Profile profile, boolean exact, int profiles, double sigma, String reason) {
    }

    /** Opens a database that exists. */
    public Store(String path) {
        if (path.indexOf('\0') >= 0) {
            throw new LensprofException(Abi.Status.ERROR_ARGUMENT, path + ": has a zero; no file has such a name");
        }
        PointerByReference opened = new PointerByReference();
        Abi.ErrorText error = new Abi.ErrorText();
        int mode = Abi.StoreMode.READ.value;
        LensprofException.check(Lensprof.LIBRARY.lensprof_store_open(path, mode, opened.getPointer(), error), error);
        store = opened.getValue();
    }

    /**
     * The profile for a setting: a stored one, or composed of the lens's falloffs at other settings and the camera's
     * response. ERROR_NOT_FOUND, with the reason, if nothing is near enough.
     */
    public synchronized Found lookup(Key key) {
        if (store == null) {
            throw new LensprofException(Abi.Status.ERROR_ARGUMENT, "this store is closed; open it again");
        }
        Profile profile = new Profile();
        Abi.Lookup how = new Abi.Lookup().init(Lensprof.LIBRARY);
        Abi.ErrorText error = new Abi.ErrorText();
        Pointer stores = new PointerByReference(store).getPointer();
        int status = Lensprof.LIBRARY.lensprof_store_lookup_in(stores, 1, key.raw(), null, profile.raw, how, error);
        LensprofException.check(status, error);
        return new Found(profile, how.exact != 0, how.rows, how.sigma, Key.text(how.reason));
    }

    @Override
    public synchronized void close() {
        Lensprof.LIBRARY.lensprof_store_close(store);
        store = null;
    }
}
