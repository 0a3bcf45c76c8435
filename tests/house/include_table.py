# SPDX-License-Identifier: GPL-3.0-or-later
"""Which folder may include which. A folder that is not listed here has no permission to include anything; the table
must have no cycles (include_graph_test.py). `room/{a b}` is room/a and room/b; `room/.` its sources outside folders.
"""

MAY_INCLUDE = {
    "data-schema/base": "",
    "data-schema/calibration": "data-schema/{base files json}",
    "data-schema/check":
        "data-schema/{base corpus device experiment files height json kinds mesh recording results scene session spectrogram texture transducer "
        "volume wav wiring}",
    "data-schema/cli":
        "data-schema/{base calibration check command corpus device exchange experiment files height kinds mesh recording report results scene session spectrogram "
        "texture transducer volume wiring}",
    "data-schema/command": "data-schema/{base files report results}",
    "data-schema/control": "data-schema/{base json results scene}",
    "data-schema/corpus": "data-schema/{base json}",
    "data-schema/device": "data-schema/{base json}",
    "data-schema/experiment": "data-schema/{base files json}",
    "data-schema/exchange": "data-schema/{base exchange/assimp exchange/matio exchange/zip files mesh texture volume}",
    "data-schema/exchange/assimp": "",
    "data-schema/exchange/matio": "",
    "data-schema/exchange/zip": "",
    "data-schema/files": "data-schema/base",
    "data-schema/height": "data-schema/{base files spectrogram}",
    "data-schema/json": "data-schema/{base files}",
    "data-schema/kinds": "data-schema/{base files height json mesh session volume}",
    "data-schema/mesh": "data-schema/{base files spectrogram}",
    "data-schema/netcdf": "",
    "data-schema/recording": "data-schema/{base files json transducer wav}",
    "data-schema/report": "data-schema/{base scene}",
    "data-schema/results": "data-schema/{base files json kinds}",
    "data-schema/scene": "data-schema/{base files json}",
    "data-schema/session": "data-schema/{base device files json scene spectrogram transducer}",
    "data-schema/spectrogram": "data-schema/{base files netcdf}",
    "data-schema/texture": "data-schema/{base files json kinds wav}",
    "data-schema/transducer": "data-schema/{base json}",
    "data-schema/volume": "data-schema/{base files spectrogram}",
    "data-schema/wav": "data-schema/{base files}",
    "data-schema/wiring": "data-schema/{base files json recording transducer}",
    "firmware-host": "data-schema/base firmware-host/{comedi link replay sim/device sim/physics sim/planar tty usb}",
    "firmware-host/boards": "",
    "firmware-host/boards/rp2350": "firmware-host/{boards/shared core/firmware core/kernel}",
    "firmware-host/boards/shared": "firmware-host/{boards core/firmware core/kernel core/wire}",
    "firmware-host/boards/stm32f405": "firmware-host/{boards/shared core/firmware}",
    "firmware-host/cli": "data-schema/{command report} firmware-host/{. sim/device}",
    "firmware-host/comedi": "data-schema/{base recording wiring} firmware-host/{core/firmware core/kernel link}",
    "firmware-host/core/firmware": "firmware-host/{core/kernel core/scene core/wire}",
    "firmware-host/core/kernel": "firmware-host/core/wire",
    "firmware-host/core/scene": "firmware-host/core/{kernel wire}",
    "firmware-host/core/wire": "",
    "firmware-host/examples": "firmware-host/core/firmware",
    "firmware-host/gadget":
        "data-schema/{base recording report} firmware-host/{core/firmware core/wire link sim/device tty}",
    "firmware-host/link":
        "data-schema/{base recording transducer} firmware-host/{core/firmware core/kernel core/wire}",
    "firmware-host/reference": "firmware-host/core/wire",
    "firmware-host/replay": "data-schema/wav firmware-host/link",
    "firmware-host/sim/bench": "data-schema/transducer firmware-host/sim/physics",
    "firmware-host/sim/device":
        "data-schema/{base transducer} firmware-host/{core/firmware core/wire link sim/bench sim/physics}",
    "firmware-host/sim/physics": "data-schema/{base texture transducer}",
    "firmware-host/sim/planar": "data-schema/device firmware-host/{core/firmware link sim/device}",
    "firmware-host/tty": "data-schema/base firmware-host/link",
    "firmware-host/usb": "data-schema/base firmware-host/{core/firmware link}",
    "capture/calibrate": "capture/record data-schema/{base calibration recording transducer} firmware-host/link",
    "capture/cli":
        "capture/{calibrate doctor import record table} data-schema/{base cli command files height kinds recording report wiring} "
        "firmware-host/{. sim/device}",
    "capture/doctor": "capture/record data-schema/{base files recording} firmware-host/{. core/wire link}",
    "capture/import": "capture/{calibrate record table} data-schema/{base calibration exchange files height mesh recording texture volume}",
    "capture/record":
        "capture/table data-schema/{base calibration files recording} firmware-host/link spatial/strokes",
    "capture/table": "data-schema/{base exchange files recording wav}",
    "spatial/certificate": "data-schema/{base texture} spatial/features",
    "spatial/cli":
        "data-schema/{base cli command files kinds recording report spectrogram texture} spatial/{certificate features "
        "job picture spectrogram texture transform}",
    "spatial/dsp/filter": "data-schema/base spatial/{dsp/fourier dsp/resample}",
    "spatial/dsp/fourier": "data-schema/files",
    "spatial/dsp/resample": "data-schema/base spatial/dsp/fourier",
    "spatial/dsp/spectrum": "data-schema/base spatial/{dsp/filter dsp/fourier dsp/resample}",
    "spatial/features":
        "data-schema/{base spectrogram texture} spatial/{dsp/filter dsp/fourier numbers spectrogram texture}",
    "spatial/job":
        "data-schema/{base command files kinds recording report texture} spatial/{dsp/filter features spectrogram strokes "
        "texture}",
    "spatial/numbers": "data-schema/{base texture} spatial/dsp/{fourier spectrum}",
    "spatial/picture": "data-schema/{base files spectrogram texture} spatial/{numbers picture/draw spectrogram}",
    "spatial/picture/draw": "data-schema/base",
    "spatial/picture/engine": "spatial/picture/draw",
    "spatial/reference": "spatial/{dsp/filter dsp/resample}",
    "spatial/spectrogram":
        "data-schema/{base results spectrogram texture} spatial/{dsp/resample dsp/spectrum numbers texture}",
    "spatial/strokes": "data-schema/{base recording} spatial/numbers",
    "spatial/texture":
        "data-schema/{base recording spectrogram texture transducer} spatial/{dsp/filter dsp/resample numbers "
        "strokes}",
    "spatial/transform":
        "data-schema/{base files texture} spatial/{dsp/filter dsp/resample numbers texture}",
    "playback/choose": "data-schema/{results scene} firmware-host/{boards core/scene} playback/{model prepare}",
    "playback/cli":
        "data-schema/{base command control device files height recording report scene session texture volume} "
        "firmware-host/{boards core/firmware core/scene link} playback/{choose control host-loop model player prepare/relief prepare/scene "
        "render session strokes}",
    "playback/control": "data-schema/{base control files}",
    "playback/daemon":
        "data-schema/{base control files report scene session} firmware-host/sim/planar playback/{control host-loop model "
        "player}",
    "playback/host-loop": "data-schema/{base session} firmware-host/{core/firmware core/kernel link} playback/prepare",
    "playback/model":
        "data-schema/{base files transducer wav} firmware-host/{core/kernel core/wire} spatial/{dsp/filter "
        "dsp/fourier dsp/resample}",
    "playback/player":
        "data-schema/{base device files height mesh scene session texture volume} firmware-host/{. core/firmware core/kernel core/wire "
        "link sim/device sim/planar} playback/{choose host-loop model prepare prepare/scene render session} "
        "spatial/dsp/resample",
    "playback/prepare":
        "data-schema/{base texture transducer} firmware-host/{core/kernel core/wire link} playback/model "
        "spatial/{dsp/filter dsp/fourier}",
    "playback/prepare/relief": "data-schema/{base height scene} firmware-host/core/scene spatial/dsp/fourier",
    "playback/prepare/scene":
        "data-schema/{device height mesh scene texture volume} firmware-host/core/scene playback/{model prepare prepare/relief "
        "stability}",
    "playback/render":
        "data-schema/{base device files recording scene texture transducer} firmware-host/{core/kernel core/scene sim/planar} "
        "playback/{choose model prepare prepare/scene render/reference} spatial/{dsp/filter features}",
    "playback/render/reference":
        "data-schema/{base device mesh volume} firmware-host/core/{kernel scene} playback/{model prepare prepare/relief prepare/scene} "
        "spatial/{dsp/filter dsp/fourier}",
    "playback/session":
        "data-schema/{base files session wav} firmware-host/{core/firmware core/kernel core/scene core/wire link} playback/model",
    "playback/stability": "data-schema/{device scene} firmware-host/{core/scene sim/planar}",
    "playback/strokes":
        "data-schema/{base texture} firmware-host/{core/firmware core/kernel core/wire} playback/{choose model render "
        "render/reference session} spatial/features",
    "playback/wasm": "firmware-host/core/firmware",
    "analysis/cli":
        "analysis/{compare corpus design experiment extremes fidelity identify/fit identify/measure identify/report live page report scene "
        "trade trade/rows trade/scene} capture/cli data-schema/{base command files kinds recording report results scene texture} "
        "firmware-host/sim/physics playback/{cli "
        "model player prepare/scene render session stability} spatial/{cli picture spectrogram}",
    "analysis/compare":
        "analysis/page data-schema/{base results session texture} playback/{session strokes} spatial/{dsp/filter "
        "dsp/fourier dsp/resample dsp/spectrum features numbers spectrogram strokes texture}",
    "analysis/corpus":
        "data-schema/{base command corpus exchange files kinds recording report texture wav} spatial/{features job}",
    "analysis/experiment":
        "analysis/{page psychometrics} capture/table data-schema/{base experiment files results session texture wav} firmware-host/core/wire "
        "playback/{model player prepare render session strokes} spatial/{dsp/filter dsp/fourier features transform}",
    "analysis/design":
        "analysis/page data-schema/{base device report results scene} firmware-host/{core/scene sim/planar} "
        "playback/{prepare/scene stability}",
    "analysis/extremes":
        "analysis/{compare identify/fit} capture/{calibrate import record table} data-schema/{base mesh recording} "
        "firmware-host/core/scene playback/{prepare prepare/scene render/reference stability} spatial/{dsp/filter dsp/resample features reference spectrogram strokes}",
    "analysis/fidelity":
        "analysis/{compare page} data-schema/{base results texture transducer} firmware-host/{sim/bench "
        "sim/device sim/physics} playback/{model player render/reference session} spatial/{dsp/filter "
        "features texture}",
    "analysis/identify/fit": "analysis/identify/measure data-schema/{base transducer} playback/model",
    "analysis/identify/measure":
        "capture/table data-schema/{base files recording} firmware-host/link spatial/dsp/fourier",
    "analysis/identify/report":
        "analysis/{identify/fit identify/measure} data-schema/{base report results} firmware-host/sim/physics "
        "spatial/{picture picture/draw}",
    "analysis/live":
        "analysis/{live/server scene} capture/{record table} data-schema/{base control files recording report spectrogram texture} firmware-host "
        "firmware-host/{core/firmware core/scene core/wire link sim/planar} playback/{control model player prepare prepare/relief wasm} "
        "spatial/{dsp/fourier features picture picture/draw spectrogram transform}",
    "analysis/live/server": "",
    "analysis/page": "data-schema/{base results} spatial/picture",
    "analysis/psychometrics": "data-schema/base",
    "analysis/report":
        "analysis/{identify/measure page} data-schema/{base calibration check corpus device experiment files height kinds mesh recording results "
        "scene session spectrogram texture transducer volume} playback/session spatial/{picture picture/draw spectrogram "
        "texture}",
    "analysis/scene":
        "data-schema/{base device height mesh report scene volume} firmware-host/core/scene playback/{prepare/scene render/reference session} "
        "spatial/{picture picture/draw}",
    "analysis/trade":
        "analysis/{page trade/offline trade/rows} data-schema/{base results texture transducer} "
        "firmware-host/sim/device playback/{choose host-loop model prepare} spatial/picture",
    "analysis/trade/offline":
        "analysis/trade/rows data-schema/{base results spectrogram texture} playback/{choose model} "
        "spatial/{dsp/spectrum reference spectrogram texture}",
    "analysis/trade/scene":
        "analysis/{design page trade/rows} data-schema/{base device report} firmware-host/{core/scene sim/planar} "
        "playback/{model prepare/relief prepare/scene render render/reference stability}",
    "analysis/trade/rows":
        "data-schema/{base texture} firmware-host/sim/physics playback/{model prepare render/reference} "
        "spatial/{dsp/fourier dsp/resample strokes texture}",
}
