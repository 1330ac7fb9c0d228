import java.io.BufferedReader;
import java.io.InputStreamReader;
import java.nio.charset.StandardCharsets;
import java.util.ArrayList;
import java.util.List;

import org.hipparchus.geometry.euclidean.threed.Rotation;
import org.hipparchus.geometry.euclidean.threed.Vector3D;
import org.orekit.data.DataSource;
import org.orekit.data.LazyLoadedDataContext;
import org.orekit.files.ccsds.ndm.ParserBuilder;
import org.orekit.files.ccsds.ndm.adm.aem.Aem;
import org.orekit.files.ccsds.ndm.adm.aem.AemSegment;
import org.orekit.time.AbsoluteDate;
import org.orekit.time.DateComponents;
import org.orekit.time.OffsetModel;
import org.orekit.utils.TimeStampedAngularCoordinates;

/**
 * Reads attitude ephemeris messages by Orekit and prints each record: message, segment, seconds of TT since J2000, quaternion (scalar last) and
 * angular velocity in body components.
 *
 * Standard input has the leap seconds, one "year month offset" a line; the arguments are files. A file that Orekit refuses is one line "refused".
 */
public class AemRival {
    public static void main(String[] files) throws Exception {
        LazyLoadedDataContext context = new LazyLoadedDataContext();
        List<OffsetModel> leaps = leaps();
        context.getTimeScales().addUTCTAIOffsetsLoader(() -> leaps);
        for (int place = 0; place < files.length; place++) {
            try {
                print(place, context, files[place]);
            } catch (Exception error) {
                System.out.println(place + " refused " + String.valueOf(error.getMessage()).replaceAll("\\s+", " "));
            }
        }
    }

    private static List<OffsetModel> leaps() throws Exception {
        List<OffsetModel> leaps = new ArrayList<>();
        BufferedReader lines = new BufferedReader(new InputStreamReader(System.in, StandardCharsets.US_ASCII));
        for (String line = lines.readLine(); line != null; line = lines.readLine()) {
            String[] words = line.trim().split(" ");
            leaps.add(new OffsetModel(new DateComponents(Integer.parseInt(words[0]), Integer.parseInt(words[1]), 1), Integer.parseInt(words[2])));
        }
        return leaps;
    }

    private static void print(int place, LazyLoadedDataContext context, String file) {
        Aem message = new ParserBuilder(context).buildAemParser().parseMessage(new DataSource(file));
        AbsoluteDate origin = new AbsoluteDate(2000, 1, 1, 12, 0, 0.0, context.getTimeScales().getTT());
        StringBuilder out = new StringBuilder();
        int number = 0;
        for (AemSegment segment : message.getSegments()) {
            for (TimeStampedAngularCoordinates state : segment.getAngularCoordinates()) {
                Rotation turn = state.getRotation();
                Vector3D rate = state.getRotationRate();
                double[] values = {
                    state.getDate().durationFrom(origin), turn.getQ1(), turn.getQ2(), turn.getQ3(), turn.getQ0(), rate.getX(), rate.getY(), rate.getZ()
                };
                out.append(place).append(' ').append(number);
                for (double value : values) {
                    out.append(' ').append(value);
                }
                out.append('\n');
            }
            number++;
        }
        System.out.print(out);
    }
}
