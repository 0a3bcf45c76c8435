# SPDX-License-Identifier: GPL-3.0-or-later
"""X3P files (ISO 25178-72), for tests and the fuzzer's corpus."""
import hashlib
import io
import zipfile

COLUMNS, ROWS = 40, 30
PITCH_X_M, PITCH_Y_M = 2e-6, 3e-6


def main_xml(letter, points, mask=None, feature="SUR", sizes=(COLUMNS, ROWS, 1), scale=1e-9, offset=5e-7, sums=True, axis="I", link=True):
    data = "<PointDataLink>bindata/data.bin</PointDataLink>" if link else ""
    if sums:
        data += f"<MD5ChecksumPointData>{hashlib.md5(points).hexdigest().upper()}</MD5ChecksumPointData>"
    if mask is not None:
        data += f"<ValidPointsLink>bindata/valid.bin</ValidPointsLink><MD5ChecksumValidPoints>{hashlib.md5(mask).hexdigest()}</MD5ChecksumValidPoints>"
    size = "".join(f"<Size{name}>{value}</Size{name}>" for name, value in zip("XYZ", sizes))
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2">
<Record1><Revision>ISO5436 - 2000</Revision><FeatureType>{feature}</FeatureType><Axes>
<CX><AxisType>{axis}</AxisType><DataType>D</DataType><Increment>{PITCH_X_M}</Increment><Offset>1e-3</Offset></CX>
<CY><AxisType>I</AxisType><DataType>D</DataType><Increment>{PITCH_Y_M}</Increment><Offset>0</Offset></CY>
<CZ><AxisType>A</AxisType><DataType>{letter}</DataType><Increment>{scale}</Increment><Offset>{offset}</Offset></CZ></Axes></Record1>
<Record2><Date>2026-11-29T12:00:00</Date><Creator>tester</Creator><Instrument><Manufacturer>M</Manufacturer><Model>T-1</Model></Instrument></Record2>
<Record3><MatrixDimension>{size}</MatrixDimension><DataLink>{data}</DataLink></Record3>
<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4></p:ISO5436_2>""".encode()


def x3p(xml, points, mask=None, folder="", more=(), sums=True, packing=zipfile.ZIP_DEFLATED):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", packing) as archive:
        files = [*more, (folder + "bindata/data.bin", points), (folder + "main.xml", xml)]
        if mask is not None:
            files.append((folder + "bindata/valid.bin", mask))
        if sums:
            files.append((folder + "md5checksum.hex", f"{hashlib.md5(xml).hexdigest()} *main.xml\n"))
        for name, content in files:
            archive.writestr(zipfile.ZipInfo(name), content, packing)  # its date is always the same
    return file.getvalue()
